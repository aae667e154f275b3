#include "render/frame/layers.h"
#include "render/image/png.h"
#include "viewer/painting/tone.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// Brightness from nothing to far too much, by factors.
Layers ramp() {
    Layers layers;
    layers.size = layers.display = {512, 64};
    layers.color = layers.inscatter = Image<vec3>(layers.size);
    layers.alpha = layers.depth = layers.transmittance = layers.validity = Image<float>(layers.size, 1);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 512; ++x) {
            const float value = x == 0 ? 0 : std::exp2(-22 + 30 * (x + y / 64.0f) / 512);
            layers.color.at(x, y) = vec3(value, 0.5f * value, 2 * value);
            layers.inscatter.at(x, y) = vec3(0.25f * value);
        }
    return layers;
}
}

TEST(Tone, ThePictureLooksAsItsPngDoes) {
    const Layers layers = ramp();
    for (const ViewTransform transform : {ViewTransform::filmic, ViewTransform::srgb}) {
        const Image<glm::u8vec4> codes = tone_map(layers, {ShownLayer::picture, 0.5, transform});
        const Image<glm::u8vec3> png = display_codes(layers.color, {0.5, transform});
        for (size_t i = 0; i < png.pixels.size(); ++i) ASSERT_EQ(codes.pixels[i], glm::u8vec4(png.pixels[i], 255)) << i;
    }
}

TEST(Tone, StopsAreFalseColorsOfLuminance) {
    Layers layers = ramp();
    for (int x = 0; x < 40; ++x)
        layers.color.at(x, 0) = vec3(0.18f * std::exp2(0.5f * static_cast<float>(x - 20) + 0.25f));
    layers.color.at(40, 0) = vec3(0), layers.color.at(41, 0) = vec3(NAN), layers.color.at(42, 0) = vec3(infinity);
    const Image<glm::u8vec4> codes = tone_map(layers, {ShownLayer::stops, 1.0});
    for (int x = 0; x < 40; ++x) {
        const int stop = static_cast<int>(std::floor(0.5 * (x - 20) + 0.25)) + 1;
        EXPECT_EQ(codes.at(x, 0), glm::u8vec4(color_of_stop(stop), 255)) << x;
    }
    EXPECT_EQ(codes.at(40, 0), glm::u8vec4(0, 0, 0, 255));
    EXPECT_EQ(codes.at(41, 0), glm::u8vec4(0, 0, 0, 255));
    EXPECT_EQ(codes.at(42, 0), glm::u8vec4(color_of_stop(highest_stop), 255));
}

TEST(Tone, OtherLayersShowWhatTheyAreNamedFor) {
    Layers layers = ramp();
    layers.transmittance.at(1, 1) = 0, layers.depth.at(2, 2) = infinity, layers.validity.at(3, 3) = 0;
    const Image<glm::u8vec4> through = tone_map(layers, {ShownLayer::transmittance, 3});
    EXPECT_EQ(through.at(1, 1).x, 0);
    EXPECT_GT(through.at(2, 1).x, 225);
    EXPECT_EQ(tone_map(layers, {ShownLayer::depth, 0}).at(2, 2).y, 0);
    const glm::u8vec4 wrong = tone_map(layers, {ShownLayer::validity, 0}).at(3, 3),
                      right = tone_map(layers, {ShownLayer::validity, 0}).at(4, 3);
    EXPECT_GT(wrong.x, 3 * wrong.y);
    EXPECT_NEAR(right.x, right.y, 1);
    const Image<glm::u8vec3> fog = display_codes(layers.inscatter, {1});
    EXPECT_NEAR(tone_map(layers, {ShownLayer::fog, 1}).at(400, 9).x, fog.at(400, 9).x, 1);
}
}

// Gobos: which way they stand, what is outside, and how large ones are reduced.
#include "scene/images.h"
#include "scene/images/image_file.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "support/expect.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
using Texel = std::array<uint8_t, 4>;
constexpr Texel black{0, 0, 0, 255}, white{255, 255, 255, 255}, red{255, 0, 0, 255}, gray{128, 128, 128, 255},
    clear{255, 255, 255, 0};

std::shared_ptr<const Gobo> gobo_of(ivec2 size, const std::vector<Texel>& texels, ColorSpace space = ColorSpace::srgb) {
    std::string note;
    return make_gobo(png_of(size, texels), space, "gobo.png", note);
}

// An L: upright along the left edge, a foot along the lower one.
std::shared_ptr<const Gobo> letter() {
    std::vector<Texel> texels(64, black);
    for (int i = 0; i < 8; ++i) texels[static_cast<size_t>(8 * i)] = texels[static_cast<size_t>(56 + i)] = white;
    return gobo_of({8, 8}, texels);
}

TEST(Gobo, StandsAsWhoLooksAlongTheLightSeesIt) {
    // A spot along -Z as a glTF camera: its right is +X, its up +Y.
    LightFilter filter;
    filter.direction = {0, 0, -1}, filter.gobo = letter();
    filter.gobo_axes = light_axes(filter.direction, {0, 1, 0}, 0);
    expect_near(filter.gobo_axes.right, vec3(1, 0, 0));
    const auto at = [&](double x, double y) { return filtered(filter, glm::normalize(dvec3(x, y, -1))).x; };
    EXPECT_NEAR(at(-0.875, 0.875), 1, 1e-6);  // head of the L: upper left
    EXPECT_NEAR(at(-0.875, -0.875), 1, 1e-6); // corner
    EXPECT_NEAR(at(0.875, -0.875), 1, 1e-6);  // foot: lower right
    EXPECT_NEAR(at(0.875, 0.875), 0, 1e-6);
    EXPECT_EQ(at(-1.2, 0), 0);
    EXPECT_EQ(at(0, -1.2), 0);
    EXPECT_EQ(filtered(filter, dvec3(0, 0, 1)), dvec3(0));
    // Counterclockwise by 90 degrees: the head goes to the lower left, the foot to the upper right.
    filter.gobo_axes = light_axes(filter.direction, {0, 1, 0}, 0.5f * pi);
    EXPECT_NEAR(at(0.875, -0.875), 1, 1e-6);
    EXPECT_NEAR(at(0.875, 0.875), 1, 1e-6);
    EXPECT_NEAR(at(-0.875, 0.875), 0, 1e-6);
    // Straight down the upper edge lies towards -Z.
    const LightAxes down = light_axes({0, -1, 0}, {0, 1, 0}, 0);
    expect_near(down.up, vec3(0, 0, -1)), expect_near(down.right, vec3(1, 0, 0));
}

TEST(Gobo, NumbersAreLightAsTheColorSpaceSays) {
    EXPECT_NEAR(gobo_at(*gobo_of({1, 1}, {gray}), 0.5, 0.5).x, 0.21586, 1e-5);
    EXPECT_NEAR(gobo_at(*gobo_of({1, 1}, {gray}, ColorSpace::linear), 0.5, 0.5).x, 128.0 / 255, 1e-6);
    EXPECT_EQ(gobo_at(*gobo_of({1, 1}, {clear}), 0.5, 0.5), dvec3(0));
    const auto color = gobo_of({2, 1}, {red, white});
    EXPECT_EQ(color->planes, 3);
    EXPECT_EQ(gobo_at(*color, 0.25, 0.5), dvec3(1, 0, 0));
    EXPECT_EQ(letter()->planes, 1);
}

TEST(Gobo, SixteenBitsAreKept) {
    std::string note;
    const std::string bytes = png16_of({2, 1}, {{100, 100, 100, 65535}, {40000, 40000, 40000, 30000}});
    const auto linear = make_gobo(bytes, ColorSpace::linear, "gobo.png", note);
    EXPECT_NEAR(gobo_at(*linear, 0.25, 0.5).x, 100.0 / 65535, 1e-8);
    EXPECT_NEAR(gobo_at(*linear, 0.75, 0.5).x, 40000.0 / 65535 * 30000 / 65535, 1e-6);
    EXPECT_NEAR(gobo_at(*make_gobo(bytes, ColorSpace::srgb, "gobo.png", note), 0.25, 0.5).x, 100.0 / 65535 / 12.92,
                1e-9);
    const Texels texture = decode_texture(bytes, "texture.png");
    EXPECT_NEAR(texel_at(texture, 0, 0).x, 100.0 / 65535 / 12.92, 1e-9);
    EXPECT_NEAR(texel_at(texture, 1, 0).w, 30000.0 / 65535, 1e-7);
}

TEST(Gobo, BlackOnesAreSaid) {
    for (const Texel texel : {black, clear, gray}) {
        std::string note;
        make_gobo(png_of({2, 1}, {black, texel}), ColorSpace::srgb, "gobo.png", note);
        EXPECT_EQ(note, texel == gray ? "" : "the image is black");
    }
}

TEST(Gobo, LevelsKeepTheMean) {
    std::vector<Texel> texels;
    for (int i = 0; i < 37 * 21; ++i) texels.push_back(i % 3 && i % 7 ? white : black);
    const auto gobo = gobo_of({37, 21}, texels);
    const auto sum = [](const Gobo::Level& level) {
        double total = 0;
        for (const float value : level.values) total += value;
        return total / (level.texels.x * level.texels.y);
    };
    for (const Gobo::Level& level : gobo->levels) EXPECT_NEAR(sum(level), sum(gobo->levels[0]), 1e-5);
    EXPECT_EQ(gobo_level(*gobo, 1.0f / 20), 0); // texels are 1 / 37 wide
    EXPECT_EQ(gobo_level(*gobo, 1.0f / 5), 2);
}

TEST(Gobo, LargePicturesAreAveragedAndSaidHugeOnesRefused) {
    std::vector<Texel> texels;
    for (int i = 0; i < 100 * 50; ++i) texels.push_back(i % 2 ? white : black);
    std::string note;
    const ReducedImage reduced = decode_reduced(png_of({100, 50}, texels), true, 8192, 32, "a.png", note);
    EXPECT_EQ(reduced.factor, 4);
    EXPECT_EQ(reduced.image.size, ivec2(25, 13));
    EXPECT_NEAR(reduced.image.at(3, 3).x, 0.5f, 1e-6f);
    EXPECT_NEAR(reduced.image.at(3, 12).x, 0.25f, 1e-6f); // half of it sticks out
    std::string huge = png_of({1, 1}, {white});
    huge.replace(16, 8, std::string("\0\0\x40\0\0\0\x40\0", 8)); // 16384²
    EXPECT_NE(
        error_message(ExitCode::refused, [&] { make_gobo(huge, ColorSpace::srgb, "huge.png", note); }).find("8192"),
        std::string::npos);
    std::string empty = png_of({1, 1}, {white});
    empty.replace(16, 8, std::string("\0\0\0\0\0\0\0\5", 8));
    EXPECT_EQ(error_message(ExitCode::refused, [&] { make_gobo(empty, ColorSpace::srgb, "empty.png", note); }),
              "empty.png: the image has 0x5 pixels; at least 1 on a side is needed");
    EXPECT_NE(error_message(ExitCode::refused, [&] { make_gobo("no picture", ColorSpace::srgb, "x.png", note); })
                  .find("x.png"),
              std::string::npos);
}
}
}

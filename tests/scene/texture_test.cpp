#include "base/error.h"
#include "base/io/file.h"
#include "scene/images.h"
#include "scene/images/image_file.h"
#include "scene/mesh.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
// Red, green, blue, white: two by two.
Texture four_texels() {
    Texture texture;
    Image<vec4> image({2, 2});
    image.pixels = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 0}};
    texture.texels = shared_texels(std::move(image));
    return texture;
}

TEST(Texture, CentersOfTexelsAreExact) {
    const Texture texture = four_texels();
    expect_near(sample_texture(texture, {0.25f, 0.25f}), {1, 0, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {0.75f, 0.25f}), {0, 1, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {0.25f, 0.75f}), {0, 0, 1, 1}, 1e-5f);
    expect_near(sample_texture(texture, {0.5f, 0.5f}), {0.5f, 0.5f, 0.5f, 0.75f}, 1e-5f);
}

// The decoder refuses such a block without saying why.
TEST(Texture, ABlockLongerThanTheFileIsRefusedInALine) {
    for (const char high : {'\x7f', '\x80', '\xff'}) {
        std::string bytes = png_of({1, 1}, {{1, 2, 3, 255}});
        bytes[bytes.find("IDAT") - 4] = high;
        const std::string message = error_of([&] { decode_texture(bytes, "here"); }).what();
        EXPECT_NE(message.find("the image is truncated"), message.npos) << message;
    }
}

TEST(Texture, RepeatsMirrorsAndHolds) {
    Texture texture = four_texels();
    expect_near(sample_texture(texture, {3.25f, -6.75f}), {1, 0, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {0, 0.25f}), {0.5f, 0.5f, 0, 1},
                1e-5f); // its left neighbor is the right texel

    texture.mirror_u = true;
    expect_near(sample_texture(texture, {1.25f, 0.25f}), {0, 1, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {-0.25f, 0.25f}), {1, 0, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {0, 0.25f}), {1, 0, 0, 1}, 1e-5f);

    texture.mirror_u = false, texture.repeat_u = texture.repeat_v = false;
    expect_near(sample_texture(texture, {-40, 0.25f}), {1, 0, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {40, 40}), {1, 1, 1, 0}, 1e-5f);
}

TEST(Texture, NearestDoesNotMix) {
    Texture texture = four_texels();
    texture.nearest = true;
    expect_near(sample_texture(texture, {0.49f, 0.49f}), {1, 0, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {0.51f, 0.49f}), {0, 1, 0, 1}, 1e-5f);
    expect_near(sample_texture(texture, {1.0f, 1.0f}), {1, 0, 0, 1}, 1e-5f);
}

TEST(Texture, AnyCoordinateGivesATexelWhoseAlphaMayBeReadAlone) {
    Texture texture = four_texels();
    for (int kinds = 0; kinds < 8; ++kinds) {
        texture.repeat_u = texture.repeat_v = kinds & 1, texture.mirror_u = texture.mirror_v = kinds & 2;
        texture.nearest = kinds & 4;
        for (const float u : {infinity, -infinity, NAN, 1e30f, -1e30f, 1e-40f, -1e-9f, 0.0f, 0.99999997f, 1.0f,
                              1.9999999f, 2.0f, -2.0f, 2.7f, -2.7f, 16777216.0f})
            for (const vec2 uv : {vec2(u), vec2(0.3f, u), vec2(u, 0.8f)}) {
                const vec4 color = sample_texture(texture, uv);
                for (int c = 0; c < 4; ++c) EXPECT_TRUE(color[c] >= 0 && color[c] <= 1) << u << ' ' << kinds;
                EXPECT_EQ(sample_alpha(texture, uv), color.w) << u << ' ' << kinds;
            }
    }
}

TEST(Texture, TransformMovesTheCoordinates) {
    Texture texture = four_texels();
    texture.uv_transform[2] = vec3(0.5f, 0, 1);
    expect_near(sample_texture(texture, {0.25f, 0.25f}), {0, 1, 0, 1}, 1e-5f);
}

TEST(ImageFile, PngBecomesLinearLight) {
    const Texels image = decode_texture(png_of({2, 1}, {{255, 188, 0, 255}, {10, 0, 128, 51}}), "test");
    ASSERT_EQ(image.size(), ivec2(2, 1));
    // IEC 61966-2-1: sRGB 188 is 0.5029 of the light, 10 is 10/255/12.92.
    expect_near(texel_at(image, 0, 0), {1, 0.502886f, 0, 1}, 1e-5f);
    expect_near(texel_at(image, 1, 0), {10 / 255.0f / 12.92f, 0, 0.215861f, 0.2f}, 1e-5f);
}

TEST(ImageFile, RefusesWhatItCannotDecode) {
    const std::string good = png_of({2, 2}, std::vector<std::array<uint8_t, 4>>(4));
    const std::string huge = png_of({20000, 20000}, {});
    for (const std::string& bytes :
         {std::string(), std::string("GIF89a"), good.substr(0, 20), good.substr(0, 50), huge}) {
        const std::string message = error_of([&] { decode_texture(bytes, "here"); }).what();
        EXPECT_EQ(message.rfind("here: ", 0), 0u) << message;
    }
    EXPECT_THROW(image_size(huge, "here"), Error);
}

TEST(ImageFile, HalvedKeepsTheLight) {
    Image<vec4> image({4, 2}, vec4(1, 0, 0, 1));
    for (int y = 0; y < 2; ++y) image.at(2, y) = image.at(3, y) = {0, 0, 1, 0.5f};
    image.at(3, 0) = {1, 1, 1, 0}; // not seen: its color must not bleed
    const Texels half = halved(Texels{{}, image});
    ASSERT_EQ(half.size(), ivec2(2, 1));
    expect_near(texel_at(half, 0, 0), {1, 0, 0, 1}, 1e-5f);
    expect_near(texel_at(half, 1, 0), {0, 0, 1, 0.375f}, 1e-5f);
    EXPECT_EQ(halved(Texels{{}, Image<vec4>({1, 5})}).size(), ivec2(1, 2));

    // Codes are averaged as light, and stay codes.
    Texels codes{Image<Code4>({2, 2}, Code4(255)), {}};
    codes.codes.at(0, 0) = {0, 0, 0, 255}, codes.codes.at(1, 1) = {0, 0, 0, 255};
    EXPECT_EQ(halved(codes).codes.at(0, 0), Code4(188, 188, 188, 255));
}

// A texture of 8-bit codes looks as one of the same linear colors does.
TEST(Texture, CodesAreLookedUpAsLinearColors) {
    const Texels codes = decode_texture(png_of({2, 2}, {{9, 80, 7, 255}, {200, 1, 3, 90}, {}, {77, 5, 61, 4}}), "test");
    ASSERT_TRUE(codes.linear.empty());
    Image<vec4> linear({2, 2});
    for (int i = 0; i < 4; ++i) linear.pixels[i] = texel_at(codes, i % 2, i / 2);
    Texture texture, same;
    texture.texels = std::make_shared<const Texels>(codes), same.texels = shared_texels(linear);
    for (const vec2 uv : {vec2(0.3f, 0.4f), vec2(0.9f, 0.1f), vec2(-3.2f, 7.77f)}) {
        EXPECT_EQ(sample_texture(texture, uv), sample_texture(same, uv));
        EXPECT_EQ(sample_alpha(texture, uv), sample_alpha(same, uv));
    }
}
}
}

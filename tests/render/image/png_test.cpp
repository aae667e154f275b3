#include "base/io/file.h"
#include "render/image/png.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

namespace tyndall::test {
namespace {
struct Decoded {
    ivec2 size{0};
    int channels = 0;
    std::vector<uint8_t> codes;
};

constexpr Display plain{0, ViewTransform::srgb};

Decoded written(const Image<vec3>& image, const Display& display = plain) {
    const TempFolder directory;
    write_png(directory.file("a.png"), image, display);
    EXPECT_EQ(directory.names(), std::vector<std::string>{"a.png"});
    const std::string bytes = read_file(directory.file("a.png"));
    Decoded result;
    uint8_t* codes =
        stbi_load_from_memory(reinterpret_cast<const uint8_t*>(bytes.data()), static_cast<int>(bytes.size()),
                              &result.size.x, &result.size.y, &result.channels, 0);
    EXPECT_NE(codes, nullptr);
    if (codes) result.codes.assign(codes, codes + size_t{3} * image.pixels.size());
    stbi_image_free(codes);
    return result;
}

double mean(const std::vector<uint8_t>& codes) {
    double sum = 0;
    for (const uint8_t code : codes) sum += code;
    return sum / static_cast<double>(codes.size());
}
}

TEST(Png, HoldsSrgb) {
    // Linear values of sRGB codes: the picture is exactly those codes, within the dither, and cut off at 1.
    const int codes[] = {0, 1, 5, 10, 11, 64, 128, 188, 200, 230, 255, 255};
    const double linear[] = {0,         0.000303527, 0.00151763, 0.00303527, 0.00334654, 0.0512695,
                             0.2158605, 0.5028865,   0.5775804,  0.7912979,  1,          7};
    for (int i = 0; i < 12; ++i) {
        const Decoded png = written(Image<vec3>({64, 64}, vec3(static_cast<float>(linear[i]))));
        EXPECT_EQ(png.size, ivec2(64, 64));
        EXPECT_EQ(png.channels, 3);
        EXPECT_NEAR(mean(png.codes), codes[i], 0.02) << codes[i];
    }
}

TEST(Png, DithersBetweenCodes) {
    // sRGB of 0.5 is code 187.516; the mean of n dithered codes deviates by at most 0.5 / sqrt(n) standard errors.
    const Decoded png = written(Image<vec3>({128, 128}, vec3(0.5f)));
    EXPECT_NEAR(mean(png.codes), 187.516, 4.5 * 0.5 / std::sqrt(3.0 * 128 * 128));
    for (const uint8_t code : png.codes) EXPECT_TRUE(code == 187 || code == 188);
    EXPECT_EQ(png.codes, written(Image<vec3>({128, 128}, vec3(0.5f))).codes);
}

TEST(Png, ExposesInStops) {
    EXPECT_NEAR(mean(written(Image<vec3>({64, 64}, vec3(0.0512695f / 4)), {2, ViewTransform::srgb}).codes), 64, 0.02);
    EXPECT_NEAR(mean(written(Image<vec3>({64, 64}, vec3(0.0512695f * 8)), {-3, ViewTransform::srgb}).codes), 64, 0.02);
    for (const float value : {0.01f, 0.4f, 5.0f})
        EXPECT_EQ(written(Image<vec3>({16, 16}, vec3(value)), {3}).codes,
                  written(Image<vec3>({16, 16}, vec3(8 * value)), {0}).codes);
}

TEST(Png, ShowsWhatIsNoColorAsBlackOrWhite) {
    Image<vec3> image({3, 1});
    image.at(0, 0) = vec3(-5, NAN, -infinity);
    image.at(1, 0) = vec3(infinity, 1e30f, 65504);
    const std::vector<uint8_t> expected{0, 0, 0, 255, 255, 255, 0, 0, 0};
    EXPECT_EQ(written(image).codes, expected);
    for (const double exposure : {0, 100}) {
        const std::vector<uint8_t> codes = written(image, {exposure}).codes;
        for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(codes[i], expected[i], 1) << i;
    }
}

TEST(Png, SaysHowItWasShown) {
    const TempFolder directory;
    write_png(directory.file("a.png"), Image<vec3>({4, 4}), {-11.3, ViewTransform::filmic});
    const std::string bytes = read_file(directory.file("a.png"));
    // Length, name, keyword, text and the CRC that zlib gives for it.
    EXPECT_NE(bytes.find(std::string("\0\0\0\x16"
                                     "tEXttyndall:exposure\0"
                                     "-11.3"
                                     "\x39\xb6\x6a\x04",
                                     34)),
              bytes.npos);
    EXPECT_NE(bytes.find(std::string("tyndall:viewTransform\0filmic", 28)), bytes.npos);
}

TEST(Png, LeavesNothingWhereItCannotWrite) {
    const TempFolder directory;
    std::filesystem::create_directory(directory.path() / "a.png");
    error_message(ExitCode::unwritable, [&] { write_png(directory.file("a.png"), Image<vec3>({4, 4}), plain); });
    EXPECT_EQ(directory.names(), std::vector<std::string>{"a.png"});
}
}

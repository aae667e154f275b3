// Radiance pictures as other programs write them.
#include "base/error.h"
#include "scene/images.h"
#include "scene/images/radiance_file.h"
#include "support/expect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using ::testing::HasSubstr;

// A byte of 128 at exponent 128 + k is 2^(k - 1).
std::string bytes_of(std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) bytes += static_cast<char>(value);
    return bytes;
}

std::string file_of(const std::string& resolution, const std::string& pixels, const std::string& header = {}) {
    return "#?RADIANCE\n" + header + "\n" + resolution + "\n" + pixels;
}

Image<vec3> decoded(const std::string& bytes) {
    std::string note;
    return decode_radiance(bytes, "sky.hdr", note);
}

std::string refusal_of(const std::string& bytes) {
    return error_of([&] { decoded(bytes); }).what();
}

// Three pixels wide, two high: red of 1, 2, 4 above 8, 16, 32.
const std::string six = bytes_of({128, 0, 0, 129, 128, 0, 0, 130, 128, 0, 0, 131, //
                                  128, 0, 0, 132, 128, 0, 0, 133, 128, 0, 0, 134});
const std::string six_by_columns = bytes_of({128, 0, 0, 129, 128, 0, 0, 132, 128, 0, 0, 130, //
                                             128, 0, 0, 133, 128, 0, 0, 131, 128, 0, 0, 134});

void expect_six(const Image<vec3>& image, bool mirrored, bool turned_over) {
    ASSERT_EQ(image.size, ivec2(3, 2));
    float red = 1;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x, red *= 2)
            EXPECT_EQ(image.at(mirrored ? 2 - x : x, turned_over ? 1 - y : y), vec3(red, 0, 0)) << x << " " << y;
}

TEST(RadianceFile, StandsUprightWhicheverWayItsLinesRun) {
    expect_six(decoded(file_of("-Y 2 +X 3", six)), false, false);
    expect_six(decoded(file_of("+Y 2 +X 3", six)), false, true);
    expect_six(decoded(file_of("-Y 2 -X 3", six)), true, false);
    expect_six(decoded(file_of("+X 3 -Y 2", six_by_columns)), false, false);
    expect_six(decoded(file_of("-X 3 +Y 2", six_by_columns)), true, true);
    EXPECT_EQ(radiance_size(file_of("+X 3 -Y 2", ""), "sky.hdr"), ivec2(3, 2));
}

TEST(RadianceFile, LinesMayEndAsInWindows) {
    EXPECT_EQ(decoded("#?RGBE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 2 +X 3\r\n" + six).size, ivec2(3, 2));
}

// Nine pixels: one and eight of its like; then two hundred, whose count takes a second byte.
TEST(RadianceFile, OldRunsRepeatThePixelBefore) {
    const Image<vec3> nine = decoded(file_of("-Y 1 +X 9", bytes_of({128, 64, 0, 129, 1, 1, 1, 8})));
    for (const vec3& pixel : nine.pixels) EXPECT_EQ(pixel, vec3(1, 0.5f, 0));
    const Image<vec3> many =
        decoded(file_of("-Y 1 +X 602", bytes_of({128, 0, 0, 129, 1, 1, 1, 88, 1, 1, 1, 2, 128, 0, 0, 130})));
    EXPECT_EQ(many.at(600, 0), vec3(1, 0, 0));
    EXPECT_EQ(many.at(601, 0), vec3(2, 0, 0));
}

TEST(RadianceFile, NewRunsHoldOneColorAfterTheOther) {
    const std::string line = bytes_of({2, 2, 0, 8, 128 + 8, 128, 3, 0, 0, 64, 128 + 5, 32, 128 + 8, 0, 128 + 8, 129});
    const Image<vec3> image = decoded(file_of("-Y 1 +X 8", line));
    EXPECT_EQ(image.at(0, 0), vec3(1, 0, 0));
    EXPECT_EQ(image.at(2, 0), vec3(1, 0.5f, 0));
    EXPECT_EQ(image.at(7, 0), vec3(1, 0.25f, 0));
}

TEST(RadianceFile, WhatPixelsWereMultipliedByIsTakenOut) {
    std::string note;
    const std::string header = "EXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR= 1 2 0.5\n";
    const Image<vec3> image =
        decode_radiance(file_of("-Y 1 +X 1", bytes_of({128, 128, 128, 132}), header), "sky.hdr", note);
    EXPECT_EQ(image.at(0, 0), vec3(1, 0.5f, 2));
    EXPECT_THAT(note, HasSubstr("EXPOSURE"));
    decode_radiance(file_of("-Y 1 +X 1", bytes_of({128, 128, 128, 132}), "EXPOSURE=1\n"), "sky.hdr", note = "");
    EXPECT_EQ(note, "");
}

TEST(RadianceFile, CutOffAnywhereItIsRefused) {
    const std::string run = bytes_of({2, 2, 0, 8, 128 + 8, 128, 8, 1, 2, 3, 4, 5, 6, 7, 8, 128 + 8, 0, 128 + 8, 129});
    for (const std::string& whole : {file_of("-Y 2 +X 3", six), file_of("-Y 1 +X 8", run)}) {
        EXPECT_NO_THROW(decoded(whole));
        for (size_t length = 0; length < whole.size(); ++length)
            EXPECT_THAT(refusal_of(whole.substr(0, length)), HasSubstr("sky.hdr: the image is truncated")) << length;
    }
}

TEST(RadianceFile, NonsenseIsRefusedInOneLine) {
    EXPECT_THAT(refusal_of(file_of("-Y 2 +Y 3", six)), HasSubstr("is not a resolution such as"));
    EXPECT_THAT(refusal_of(file_of("-Y 0 +X 3", six)), HasSubstr("is not a resolution such as"));
    EXPECT_THAT(refusal_of(file_of("-Y 2 +X 99999999999", six)), HasSubstr("is not a resolution such as"));
    EXPECT_THAT(refusal_of(file_of("-Y 1 +X 9", bytes_of({128, 0, 0, 129, 1, 1, 1, 9}))), HasSubstr("a run exceeds"));
    EXPECT_THAT(refusal_of(file_of("-Y 1 +X 8", bytes_of({2, 2, 0, 8, 255, 1, 0, 0, 0, 0}))),
                HasSubstr("a run exceeds"));
    EXPECT_THAT(refusal_of(file_of("-Y 1 +X 1", six, "EXPOSURE=0\n")), HasSubstr("is not a factor above 0"));
    EXPECT_THAT(refusal_of(file_of("-Y 1 +X 1", six, "FORMAT=32-bit_rle_xyze\n")), HasSubstr("32-bit_rle_xyze"));
}
}
}

// Pictures with more light than a screen has: Radiance and OpenEXR.
#include "base/error.h"
#include "base/io/file.h"
#include "scene/images.h"
#include "scene/images/image_file.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

namespace tyndall {
namespace {
using ::testing::HasSubstr;

TEST(ImageFile, RadianceKeepsItsRange) {
    const TempFolder folder;
    // RGBE: mantissa / 256 · 2^(exponent - 128).
    const auto file = folder.put("sky.hdr", radiance_of({2, 1}, {{128, 64, 0, 132}, {0, 0, 0, 0}}));
    std::string note;
    const Image<vec3> image = decode_image(read_file(file), "test", note);
    ASSERT_EQ(image.size, ivec2(2, 1));
    EXPECT_EQ(image.at(0, 0), vec3(8, 4, 0));
    EXPECT_EQ(image.at(1, 0), vec3(0));
}

// Bytes of an EXR with these pixels in a window of a larger picture.
std::string openexr_of(const TempFolder& folder, ivec2 display, ivec2 low, const Image<vec3>& pixels,
                       bool gray = false) {
    const auto file = folder.path() / "picture.exr";
    const ivec2 high = low + pixels.size - 1;
    Imf::Header header(Imath::Box2i({0, 0}, {display.x - 1, display.y - 1}),
                       Imath::Box2i({low.x, low.y}, {high.x, high.y}));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    const std::vector<std::string> names =
        gray ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
    for (size_t c = 0; c < names.size(); ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        auto* values = reinterpret_cast<const char*>(pixels.pixels.data()) + c * sizeof(float);
        buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, values, header.dataWindow(), sizeof(vec3),
                                                 sizeof(vec3) * static_cast<size_t>(pixels.size.x)));
    }
    {
        Imf::OutputFile output(file.c_str(), header);
        output.setFrameBuffer(buffer);
        output.writePixels(pixels.size.y);
    }
    return read_file(file);
}

TEST(ImageFile, OpenExrFillsItsDisplayWindow) {
    const TempFolder folder;
    Image<vec3> pixels({2, 1});
    pixels.pixels = {{70000, 0.5f, 0.25f}, {1, -2, 3}};
    const std::string bytes = openexr_of(folder, {4, 2}, {1, 1}, pixels);
    EXPECT_EQ(image_format(bytes), ImageFormat::openexr);
    std::string note;
    const Image<vec3> image = decode_image(bytes, "test", note);
    ASSERT_EQ(image.size, ivec2(4, 2));
    EXPECT_EQ(image.at(1, 1), vec3(70000, 0.5f, 0.25f));
    EXPECT_EQ(image.at(2, 1), vec3(1, 0, 3));
    EXPECT_EQ(image.at(0, 0), vec3(0));
    EXPECT_EQ(image.at(3, 1), vec3(0));
    EXPECT_THAT(note, HasSubstr("1 pixel with negative values"));

    const Image<vec3> gray = decode_image(openexr_of(folder, {2, 1}, {0, 0}, pixels, true), "test", note);
    EXPECT_EQ(gray.at(0, 0), vec3(70000));
    const ReducedImage half = decode_reduced(openexr_of(folder, {2, 1}, {0, 0}, pixels), false, 100, 1, "test", note);
    EXPECT_EQ(half.factor, 2);
    EXPECT_EQ(half.image.at(0, 0), vec3(70001, -1.5f, 3.25f) / 4.0f);
}

// Suns brighter than the largest half float are infinite in files of halves.
TEST(ImageFile, InfiniteSuns) {
    const TempFolder folder;
    Image<vec3> pixels({2, 1}, vec3(1));
    pixels.at(1, 0) = {infinity, 3, infinity};
    std::string note;
    Image<vec3> sky = decode_image(openexr_of(folder, {2, 1}, {0, 0}, pixels), "test", note);
    EXPECT_EQ(sky.at(1, 0), vec3(65504, 3, 65504));
    EXPECT_THAT(note, HasSubstr("1 infinite pixel, read as 65504"));
    pixels.at(0, 0).x = 1e5f;
    sky = decode_image(openexr_of(folder, {2, 1}, {0, 0}, pixels), "test", note);
    EXPECT_EQ(sky.at(1, 0), vec3(1e5f, 3, 1e5f));
}

TEST(ImageFile, OpenExrThatIsNoPicture) {
    const TempFolder folder;
    std::string note;
    const auto refusal = [&](const std::string& bytes) {
        return std::string(error_of([&] { decode_image(bytes, "sky.exr", note); }).what());
    };
    Image<vec3> pixels({2, 1}, vec3(1));
    const std::string whole = openexr_of(folder, {2, 1}, {0, 0}, pixels);
    EXPECT_THAT(refusal(whole.substr(0, whole.size() - 4)), HasSubstr("sky.exr"));
    EXPECT_THAT(refusal(openexr_of(folder, {16000, 16000}, {0, 0}, pixels)), HasSubstr("less than 1/16"));
    pixels.at(1, 0).y = -std::numeric_limits<float>::infinity();
    EXPECT_THAT(refusal(openexr_of(folder, {2, 1}, {0, 0}, pixels)),
                HasSubstr("1 pixel is not finite (-inf or NaN), at x 1, y 0 from the upper left; "));
    Image<vec3> larger({5, 4}, vec3(1));
    larger.at(3, 2).x = std::numeric_limits<float>::quiet_NaN(), larger.at(0, 3) = vec3(-1 / 0.0f);
    EXPECT_THAT(refusal(openexr_of(folder, {6, 4}, {1, 0}, larger)),
                HasSubstr("2 pixels are not finite (-inf or NaN), the first one at x 4, y 2 from the upper left; "));
}
}
}

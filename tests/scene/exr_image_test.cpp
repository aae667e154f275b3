// OpenEXR pictures as programs write them: each compression, tiles, parts, luminance and chroma; and damaged ones.
#include "base/error.h"
#include "base/exr/exr_image.h"
#include "base/io/file.h"
#include "base/random.h"
#include "scene/images/image_file.h"
#include "support/corpus.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <sys/resource.h>

namespace tyndall {
namespace {
using ::testing::HasSubstr;

// A sky: smooth, bright around one place, noise of the last digits.
Image<vec3> sky_of(ivec2 size) {
    Image<vec3> sky(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const vec2 at = vec2(x, y) / vec2(size);
            const float sun = 50 * std::exp(-40 * glm::dot(at - vec2(.7f, .3f), at - vec2(.7f, .3f)));
            const float grain = .01f * to_unit(hash(static_cast<uint32_t>(y * size.x + x)));
            sky.at(x, y) = vec3(.2f, .4f, .8f) * (1.2f - at.y) + sun * vec3(1, .9f, .7f) + grain;
        }
    return sky;
}

struct Written {
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    Imf::PixelType type = Imf::HALF;
    ivec2 low{0}, display{0}; // display: 0 = the pixels' size
};

Imf::Header header_of(const Image<vec3>& pixels, const Written& as) {
    const ivec2 high = as.low + pixels.size - 1, display = as.display == ivec2(0) ? pixels.size : as.display;
    Imf::Header header(Imath::Box2i({0, 0}, {display.x - 1, display.y - 1}),
                       Imath::Box2i({as.low.x, as.low.y}, {high.x, high.y}));
    header.compression() = as.compression;
    for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(as.type));
    return header;
}

// The numbers of the pixels as a type of channels, and how the library finds them.
struct Plane {
    std::vector<half> halves;
    std::vector<uint32_t> integers;
    Imf::FrameBuffer buffer;

    Plane(const Image<vec3>& pixels, const Written& as) {
        const float* values = &pixels.pixels[0].x;
        const size_t count = 3 * pixels.pixels.size(), bytes = as.type == Imf::HALF ? 2 : 4;
        halves.assign(values, values + count), integers.assign(values, values + count);
        const void* first = values;
        if (as.type == Imf::HALF) first = halves.data();
        if (as.type == Imf::UINT) first = integers.data();
        const ivec2 high = as.low + pixels.size - 1;
        const Imath::Box2i window({as.low.x, as.low.y}, {high.x, high.y});
        for (size_t c = 0; c < 3; ++c)
            buffer.insert(std::string(1, "RGB"[c]),
                          Imf::Slice::Make(as.type, static_cast<const char*>(first) + c * bytes, window, 3 * bytes,
                                           3 * bytes * static_cast<size_t>(pixels.size.x)));
    }
};

std::string lines_of(const TempFolder& folder, const Image<vec3>& pixels, const Written& as) {
    const Plane plane(pixels, as);
    {
        Imf::OutputFile output(folder.file("a.exr").c_str(), header_of(pixels, as));
        output.setFrameBuffer(plane.buffer);
        output.writePixels(pixels.size.y);
    }
    return read_file(folder.file("a.exr"));
}

// The levels after the first are black.
std::string tiles_of(const TempFolder& folder, const Image<vec3>& pixels, const Written& as, Imf::LevelMode mode) {
    const Plane plane(pixels, as), black(Image<vec3>(pixels.size), as);
    Imf::Header header = header_of(pixels, as);
    header.setTileDescription(Imf::TileDescription(32, 16, mode));
    {
        Imf::TiledOutputFile output(folder.file("a.exr").c_str(), header);
        for (int y = 0; y < output.numYLevels(); ++y)
            for (int x = 0; x < output.numXLevels(); ++x) {
                if (!output.isValidLevel(x, y)) continue;
                output.setFrameBuffer(x + y == 0 ? plane.buffer : black.buffer);
                output.writeTiles(0, output.numXTiles(x) - 1, 0, output.numYTiles(y) - 1, x, y);
            }
    }
    return read_file(folder.file("a.exr"));
}

// A part of depth, then the colors.
std::string parts_of(const TempFolder& folder, const Image<vec3>& pixels, const Written& as) {
    const Plane plane(pixels, as);
    Imf::Header colors = header_of(pixels, as), depth = header_of(pixels, {});
    colors.setName("rgb"), colors.setType("scanlineimage"), depth.setName("depth"), depth.setType("scanlineimage");
    depth.channels() = Imf::ChannelList();
    depth.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    const std::vector<float> far(pixels.pixels.size(), 1e6f);
    Imf::FrameBuffer buffer;
    buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, far.data(), depth.dataWindow()));
    const Imf::Header headers[] = {depth, colors};
    {
        Imf::MultiPartOutputFile output(folder.file("a.exr").c_str(), headers, 2);
        Imf::OutputPart first(output, 0), second(output, 1);
        first.setFrameBuffer(buffer), first.writePixels(pixels.size.y);
        second.setFrameBuffer(plane.buffer), second.writePixels(pixels.size.y);
    }
    return read_file(folder.file("a.exr"));
}

std::string chroma_of(const TempFolder& folder, const Image<vec3>& pixels, Imf::RgbaChannels channels) {
    std::vector<Imf::Rgba> values;
    for (const vec3& pixel : pixels.pixels) values.push_back({pixel.x, pixel.y, pixel.z});
    {
        Imf::RgbaOutputFile output(folder.file("a.exr").c_str(), pixels.size.x, pixels.size.y, channels, 1,
                                   Imath::V2f(0, 0), 1, Imf::INCREASING_Y, Imf::PIZ_COMPRESSION);
        output.setFrameBuffer(values.data(), 1, static_cast<size_t>(pixels.size.x));
        output.writePixels(pixels.size.y);
    }
    return read_file(folder.file("a.exr"));
}

// The largest error of any value, over its pixel's brightness.
double error_against(const Image<vec3>& expected, const std::string& bytes) {
    std::string note;
    const Image<vec3> image = decode_image(bytes, "sky.exr", note);
    EXPECT_EQ(image.size, expected.size);
    EXPECT_EQ(note, "");
    double error = 0;
    for (size_t i = 0; i < expected.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const vec3 pixel = expected.pixels[i];
            const float brightness = std::max({pixel.x, pixel.y, pixel.z});
            error = std::max(error, std::abs(double(image.pixels[i][c]) - pixel[c]) / brightness);
        }
    return error;
}

constexpr Imf::Compression all_compressions[] = {
    Imf::NO_COMPRESSION,    Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,  Imf::PIZ_COMPRESSION,
    Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};

// Half floats err by 2^-11 of a value; B44 and DWA by design.
double allowed(Imf::Compression compression) { return compression >= Imf::B44_COMPRESSION ? .05 : 1.0 / 2048; }

TEST(ExrImage, EachCompressionOfLinesAndTiles) {
    const TempFolder folder;
    const Image<vec3> sky = sky_of({77, 301});
    for (const Imf::Compression compression : all_compressions) {
        SCOPED_TRACE(compression);
        EXPECT_LE(error_against(sky, lines_of(folder, sky, {compression})), allowed(compression));
        for (const auto mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS})
            EXPECT_LE(error_against(sky, tiles_of(folder, sky, {compression}, mode)), allowed(compression));
    }
}

TEST(ExrImage, EachTypeOfNumber) {
    const TempFolder folder;
    const Image<vec3> sky = sky_of({40, 70});
    EXPECT_EQ(error_against(sky, lines_of(folder, sky, {Imf::PIZ_COMPRESSION, Imf::FLOAT})), 0);
    EXPECT_EQ(error_against(sky, tiles_of(folder, sky, {Imf::PIZ_COMPRESSION, Imf::FLOAT}, Imf::MIPMAP_LEVELS)), 0);
    EXPECT_LE(error_against(sky, lines_of(folder, sky, {Imf::PXR24_COMPRESSION, Imf::FLOAT})), 1.0 / 32768);
    Image<vec3> whole = sky;
    for (vec3& pixel : whole.pixels) pixel = glm::floor(100.0f * pixel);
    EXPECT_EQ(error_against(whole, lines_of(folder, whole, {Imf::PIZ_COMPRESSION, Imf::UINT})), 0);
}

TEST(ExrImage, PartsLuminanceAndChroma) {
    const TempFolder folder;
    const Image<vec3> sky = sky_of({64, 48});
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAA_COMPRESSION})
        EXPECT_LE(error_against(sky, parts_of(folder, sky, {compression})), allowed(compression));
    EXPECT_LE(error_against(sky, chroma_of(folder, sky, Imf::WRITE_YC)), .1);
    Image<vec3> gray = sky;
    for (vec3& pixel : gray.pixels) pixel = vec3(pixel.y);
    EXPECT_LE(error_against(gray, chroma_of(folder, gray, Imf::WRITE_Y)), 1.0 / 2048);
}

TEST(ExrImage, WindowsLieAnywhere) {
    const TempFolder folder;
    const Image<vec3> sky = sky_of({20, 12});
    std::string note;
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
        const Image<vec3> larger =
            decode_image(lines_of(folder, sky, {compression, Imf::FLOAT, {5, 3}, {30, 16}}), "sky.exr", note);
        ASSERT_EQ(larger.size, ivec2(30, 16));
        EXPECT_EQ(larger.at(5, 3), sky.at(0, 0));
        EXPECT_EQ(larger.at(24, 14), sky.at(19, 11));
        EXPECT_EQ(larger.at(4, 3), vec3(0));
        const Written cut{compression, Imf::FLOAT, {-4, -2}, {10, 8}};
        const Image<vec3> smaller = decode_image(tiles_of(folder, sky, cut, Imf::MIPMAP_LEVELS), "sky.exr", note);
        ASSERT_EQ(smaller.size, ivec2(10, 8));
        EXPECT_EQ(smaller.at(0, 0), sky.at(4, 2));
        EXPECT_EQ(smaller.at(9, 7), sky.at(13, 9));
    }
}

std::string refusal(const std::string& bytes) {
    std::string note;
    return error_message(ExitCode::refused, [&] { decode_image(bytes, "sky.exr", note); });
}

TEST(ExrImage, SaysWhatItIsNot) {
    const TempFolder folder;
    const Image<vec3> sky = sky_of({16, 8});
    const Plane plane(sky, {});
    const auto written = [&](const Imf::Header& header, const Imf::FrameBuffer& buffer) {
        {
            Imf::OutputFile output(folder.file("b.exr").c_str(), header);
            output.setFrameBuffer(buffer);
            output.writePixels(sky.size.y);
        }
        return read_file(folder.file("b.exr"));
    };
    Imf::Header cube = header_of(sky, {});
    Imf::addEnvmap(cube, Imf::ENVMAP_CUBE);
    EXPECT_THAT(refusal(written(cube, plane.buffer)), HasSubstr("exrenvmap"));
    Imf::Header layers = header_of(sky, {});
    layers.channels() = Imf::ChannelList();
    layers.channels().insert("Combined.R", Imf::Channel(Imf::HALF));
    EXPECT_THAT(refusal(written(layers, {})), HasSubstr("it has Combined.R"));

    Imf::Header wide = header_of(sky, {});
    Imf::addChromaticities(wide, {{.7347f, .2653f}, {0, 1}, {.0001f, -.077f}, {.32168f, .33767f}});
    std::string note;
    decode_image(written(wide, plane.buffer), "sky.exr", note);
    EXPECT_THAT(note, HasSubstr("not Rec.709"));
}

struct Seed {
    std::string bytes;
    bool repeats = true; // the library leaves parts of damaged DWA blocks as it finds the memory
};

// Whatever the bytes, a picture or one line; and the same of the same bytes.
void expect_picture_or_line(const std::string& bytes, bool repeats) {
    const auto outcome = [&] {
        std::string note;
        try {
            const Image<vec3> image = decode_image(bytes, "sky.exr", note);
            return content_hash(std::string_view(reinterpret_cast<const char*>(image.pixels.data()),
                                                 image.pixels.size() * sizeof(vec3)));
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::refused) << error.what();
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
            return std::string(error.what());
        }
    };
    const std::string first = outcome(), second = outcome();
    if (repeats) {
        EXPECT_EQ(first, second);
    }
}

// Small files of each way to store a picture.
std::vector<Seed> seeds(const TempFolder& folder) {
    const Image<vec3> sky = sky_of({40, 70});
    std::vector<Seed> files;
    for (const Imf::Compression compression : all_compressions)
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
            const bool repeats = compression < Imf::DWAA_COMPRESSION;
            files.push_back({lines_of(folder, sky, {compression, type}), repeats});
            files.push_back({tiles_of(folder, sky, {compression, type}, Imf::MIPMAP_LEVELS), repeats});
        }
    files.push_back({parts_of(folder, sky, {Imf::PIZ_COMPRESSION})});
    files.push_back({parts_of(folder, sky, {Imf::DWAB_COMPRESSION}), false});
    files.push_back({chroma_of(folder, sky, Imf::WRITE_YC)});
    return files;
}

std::string damaged(std::string bytes, uint32_t file, uint32_t n) {
    const auto random = [&](uint32_t k) { return hash(file, n, k); };
    if (n % 8 == 0) bytes.resize(random(0) % bytes.size());
    const size_t first = n % 8 < 3 ? std::min<size_t>(bytes.size(), 800) : bytes.size(); // headers, or all
    for (uint32_t change = 0; first > 0 && change < 1 + n % 4; ++change) {
        const char values[] = {static_cast<char>(random(3 * change + 2)), '\0', '\xff', '\x7f'};
        bytes[random(3 * change + 1) % first] = values[random(3 * change + 3) % 4];
    }
    return bytes;
}

void cut_and_change(const std::vector<Seed>& files, uint32_t times) {
    for (uint32_t file = 0; file < files.size(); ++file)
        for (uint32_t n = 0; n < times; ++n) {
            SCOPED_TRACE(std::to_string(file) + ": " + std::to_string(n));
            expect_picture_or_line(damaged(files[file].bytes, file, n), files[file].repeats);
        }
}

TEST(ExrImage, DamagedFilesAreOneLine) {
    const TempFolder folder;
    cut_and_change(seeds(folder), 60);
}

TEST(ExrImage, NightlyManyDamagedFilesAreOneLine) {
    const TempFolder folder;
    cut_and_change(seeds(folder), 3000);
}

// A few hundred bytes may claim no more memory than their kind of compression can mean.
TEST(ExrImage, SmallFilesOfLargeClaims) {
    const TempFolder folder;
    const std::string whole = lines_of(folder, sky_of({16, 8}), {Imf::PIZ_COMPRESSION});
    const size_t window = whole.find("dataWindow");
    for (const int side : {2000, 16383, 16384, 1 << 23}) {
        std::string bytes = whole;
        for (int c = 0; c < 2; ++c) std::memcpy(&bytes[window + 29 + 4 * static_cast<size_t>(c)], &side, 4);
        EXPECT_NE(refusal(bytes), "");
    }
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 1 << 20); // KiB
}
}
}

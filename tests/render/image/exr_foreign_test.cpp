// Files by others: valid ones of every kind, and a corpus that once crashed readers.
#include "render/image/exr.h"
#include "support/corpus.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

namespace tyndall::test {
namespace {
void put(std::string& bytes, int32_t value) { bytes.append(reinterpret_cast<const char*>(&value), 4); }
void put_name(std::string& bytes, const std::string& name) { bytes.append(name.c_str(), name.size() + 1); }
void put_attribute(std::string& bytes, const std::string& name, const std::string& type, const std::string& value) {
    put_name(bytes, name), put_name(bytes, type), put(bytes, static_cast<int32_t>(value.size())), bytes += value;
}
std::string box(int x0, int y0, int x1, int y1) {
    std::string bytes;
    for (const int c : {x0, y0, x1, y1}) put(bytes, c);
    return bytes;
}

// A header by hand, with room for anything to be wrong.
struct HandMade {
    int32_t version = 2;
    std::string data = box(0, 0, 3, 3), display = box(0, 0, 3, 3), compression = std::string(1, '\0');
    int32_t channel_type = 1, sampling = 1;
    std::string extra; // attributes

    std::string bytes() const {
        std::string result, channels;
        put(result, 20000630), put(result, version);
        put_name(channels, "R");
        put(channels, channel_type), put(channels, 0), put(channels, sampling), put(channels, sampling);
        channels += '\0';
        put_attribute(result, "channels", "chlist", channels);
        put_attribute(result, "compression", "compression", compression);
        put_attribute(result, "dataWindow", "box2i", data);
        put_attribute(result, "displayWindow", "box2i", display);
        put_attribute(result, "lineOrder", "lineOrder", std::string(1, '\0'));
        std::string one(4, '\0');
        one[2] = '\x80', one[3] = '\x3f';
        put_attribute(result, "pixelAspectRatio", "float", one);
        put_attribute(result, "screenWindowCenter", "v2f", std::string(8, '\0'));
        put_attribute(result, "screenWindowWidth", "float", one);
        return result + extra + '\0';
    }
    std::string with_pixels() const {
        std::string result = bytes();
        const size_t table = result.size();
        for (int y = 0; y < 4; ++y) {
            const uint64_t offset = table + 32 + static_cast<size_t>(y) * 16;
            result.append(reinterpret_cast<const char*>(&offset), 8);
        }
        for (int y = 0; y < 4; ++y) put(result, y), put(result, 8), result.append(8, static_cast<char>(0x3c));
        return result;
    }
};

std::string refusal(const std::string& bytes) {
    const TempFolder directory;
    std::ofstream(directory.file("x.exr"), std::ios::binary) << bytes;
    return error_message(ExitCode::refused, [&] { read_exr(directory.file("x.exr")); });
}

void expect_refused(const std::string& bytes, const std::string& reason) {
    const std::string text = refusal(bytes);
    EXPECT_NE(text.find(reason), text.npos) << "expected '" << reason << "' in '" << text << "'";
}
}

TEST(ExrForeign, ReadsAMinimalFile) {
    const TempFolder directory;
    std::ofstream(directory.file("x.exr"), std::ios::binary) << HandMade{}.with_pixels();
    const ExrFile exr = read_exr(directory.file("x.exr"));
    EXPECT_EQ(exr.compression, "none");
    for (const float value : exr.channel("R")->pixels) EXPECT_NEAR(value, 1.05859375f, 0);
}

TEST(ExrForeign, RefusesWhatItDoesNotRead) {
    const auto with = [](auto change) {
        HandMade file;
        change(file);
        return file.with_pixels();
    };
    expect_refused("", "not an OpenEXR file");
    expect_refused("version https://git-lfs.github.com/spec/v1\noid sha256:0", "not an OpenEXR file");
    expect_refused(with([](auto& f) { f.version = 1; }), "version");
    expect_refused(with([](auto& f) { f.version = 2 | 0x200; }), "lacks tiles");
    expect_refused(with([](auto& f) { f.version = 2 | 0x800; }), "deep");
    expect_refused(with([](auto& f) { f.version = 2 | 0x1200; }), "contradict each other");
    expect_refused(with([](auto& f) { f.version = 2 | 0x8000; }), "unknown flags");
    for (const int c : {10, 255})
        expect_refused(with([&](auto& f) { f.compression = std::string(1, static_cast<char>(c)); }),
                       "unknown compression");
    expect_refused(with([](auto& f) { f.sampling = 2; }), "subsampled");
    expect_refused(with([](auto& f) { f.sampling = 3; }), "subsampling must be");
    expect_refused(with([](auto& f) { f.channel_type = 3; }), "pixel type");
    expect_refused(with([](auto& f) { put_attribute(f.extra, "type", "string", "deepscanline"); }), "scanline");
}

TEST(ExrForeign, RefusesClaimsBeforeBelievingThem) {
    const auto with = [](auto change) {
        HandMade file;
        change(file);
        return file.with_pixels();
    };
    expect_refused(with([](auto& f) { f.data = box(0, 0, 16384, 3); }), "16384");
    expect_refused(with([](auto& f) { f.data = box(0, 0, 16383, 16383); }), "too short");
    expect_refused(with([](auto& f) { f.data = box(0, 0, -1, 3); }), "empty");
    expect_refused(with([](auto& f) { f.data = box(INT32_MIN, 0, INT32_MAX, 3); }), "out of range");
    expect_refused(with([](auto& f) { f.display = box(0, INT32_MIN, 5, INT32_MAX); }), "out of range");
    expect_refused(with([](auto& f) { f.data = box(0, 0, 3, 3) + "x"; }), "wrong size");
    expect_refused(with([](auto& f) { put_attribute(f.extra, "dataWindow", "box2i", box(0, 0, 1, 1)); }), "twice");
    expect_refused(with([](auto& f) { put_name(f.extra, "a"), put_name(f.extra, "string"), put(f.extra, INT32_MAX); }),
                   "truncated");
    expect_refused(with([](auto& f) { put_name(f.extra, "a"), put_name(f.extra, "string"), put(f.extra, -1); }),
                   "negative size");
    expect_refused(with([](auto& f) { put_name(f.extra, std::string(300, 'a')); }), "unterminated name");
    expect_refused(with([](auto& f) {
                       for (int i = 0; i < 5000; ++i) put_attribute(f.extra, "a" + std::to_string(i), "string", "");
                   }),
                   "4096");
}

// The library would fill such gaps with what memory happens to hold.
TEST(ExrForeign, RefusesBlocksThatAreNotWholeOrNotWhereTheyBelong) {
    const std::string whole = HandMade{}.with_pixels();
    const size_t table = HandMade{}.bytes().size(), blocks = table + 32;
    const auto with = [&](size_t place, uint64_t value, size_t bytes) {
        std::string file = whole;
        std::memcpy(file.data() + place, &value, bytes);
        return file;
    };
    for (size_t line = 0; line < 4; ++line) {
        expect_refused(with(table + 8 * line, 0, 8), "damaged"); // reads the header as a block
        expect_refused(with(table + 8 * line, UINT64_MAX, 8), "missing");
        expect_refused(with(table + 8 * line, blocks + 16 * ((line + 1) % 4), 8), "damaged"); // another line
        for (const uint64_t size : {0u, 7u, 9u, 0x7fffffffu, 0x80000000u})
            expect_refused(with(blocks + 16 * line + 4, size, 4), "damaged");
        expect_refused(with(blocks + 16 * line, line + 4, 4), "damaged");
    }
    expect_refused(whole.substr(0, whole.size() - 1), "damaged");
}

TEST(ExrForeign, RefusesPackedBlocksThatHoldTooLittle) {
    const auto packed = [](int compression, const std::string& block) {
        HandMade file;
        file.data = file.display = box(0, 0, 7, 0), file.compression = std::string(1, static_cast<char>(compression));
        std::string result = file.bytes();
        const uint64_t offset = result.size() + 8;
        result.append(reinterpret_cast<const char*>(&offset), 8);
        put(result, 0), put(result, static_cast<int32_t>(block.size()));
        return result + block;
    };
    const TempFolder directory;
    std::ofstream(directory.file("x.exr"), std::ios::binary) << packed(1, {15, 0}); // sixteen bytes
    EXPECT_EQ(read_exr(directory.file("x.exr")).channel("R")->pixels.size(), 8u);
    expect_refused(packed(1, {14, 0}), "damaged");
    expect_refused(packed(1, {16, 0}), "damaged");
    expect_refused(packed(1, {-7, 0, 0}), "damaged");
    expect_refused(packed(2, "\x78\x9c"), "damaged");
    expect_refused(packed(3, std::string("\x78\x9c\x03\0\0\0\0\x01", 8)), "damaged"); // of no bytes, or cut
}

TEST(ExrForeign, ReadsOrRefusesTheValidCollection) {
    int read = 0, refused = 0;
    for (const std::filesystem::path& file : corpus_files("exr/openexr-valid", {".exr"})) {
        try {
            const ExrFile exr = read_exr(file);
            EXPECT_FALSE(exr.channels.empty());
            ++read;
        } catch (const Error& error) {
            const std::string text = error.what();
            EXPECT_EQ(static_cast<int>(error.code), static_cast<int>(ExitCode::refused)) << text;
            EXPECT_NE(text.find("multi-part"), text.npos) << text;
            ++refused;
        }
    }
    EXPECT_GE(read, 6);
}

TEST(ExrForeign, RefusesTheDamagedCollection) {
    int refused = 0;
    for (const std::filesystem::path& file : corpus_files("exr/openexr-damaged")) {
        if (file.filename() == "LICENSE" || file.extension() == ".rst") continue;
        const std::string text = error_message(ExitCode::refused, [&] { read_exr(file); });
        EXPECT_NE(text.find("exr"), text.npos);
        ++refused;
    }
    EXPECT_GE(refused, 25);
}
}

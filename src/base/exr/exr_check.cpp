#include "base/exr/exr_check.h"

#include "base/error.h"
#include "base/exr/exr_file.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

namespace tyndall {
namespace {
constexpr int largest_side = 16384, max_attributes = 4096;
constexpr int largest_coordinate = 1 << 24;
constexpr uint64_t best_ratio = 1032; // of deflate; run lengths reach 64

enum Compression { none, run_lengths, zip_lines, zip_blocks }; // as files number them

enum : uint32_t { tiled_flag = 0x200, long_names_flag = 0x400, deep_flag = 0x800, multipart_flag = 0x1000 };

struct Cursor {
    std::string_view left;
    const std::string& file;

    std::string_view bytes(size_t count) {
        if (count > left.size()) refuse(file, "the file ends early");
        const std::string_view result = left.substr(0, count);
        left.remove_prefix(count);
        return result;
    }
    template<class T> T number() {
        T value;
        std::memcpy(&value, bytes(sizeof(T)).data(), sizeof(T));
        return value;
    }
    int32_t integer() { return number<int32_t>(); }
    std::string_view name() {
        const size_t end = left.substr(0, 256).find('\0');
        if (end == std::string_view::npos) refuse(file, "the header holds a name without an end");
        const std::string_view result = bytes(end);
        bytes(1);
        return result;
    }
};

void read_channels(Cursor cursor, ExrClaims& claims) {
    while (!cursor.name().empty()) {
        const int type = cursor.integer();
        cursor.bytes(4); // perceptual flag, reserved
        const int step_x = cursor.integer(), step_y = cursor.integer();
        if (type < 0 || type > 2) refuse(cursor.file, "a channel has an unknown pixel type");
        if (step_x != 1 || step_y != 1) refuse(cursor.file, "channels of reduced resolution are not read");
        if (++claims.channels > max_channels) refuse(cursor.file, "more than 1024 channels");
        claims.bytes_per_pixel += type == 1 ? 2 : 4;
    }
    if (claims.channels == 0) refuse(cursor.file, "there are no channels");
}

void read_window(Cursor cursor, ivec2& low, ivec2& high) {
    if (cursor.left.size() != 16) refuse(cursor.file, "a window has the wrong size");
    low.x = cursor.integer(), low.y = cursor.integer(), high.x = cursor.integer(), high.y = cursor.integer();
    for (const int c : {low.x, low.y, high.x, high.y})
        if (c < -largest_coordinate || c > largest_coordinate) refuse(cursor.file, "a window is out of range");
    if (low.x > high.x || low.y > high.y) refuse(cursor.file, "a window is empty");
}

void read_compression(Cursor cursor, ExrClaims& claims) {
    claims.compression = static_cast<unsigned char>(cursor.bytes(1)[0]);
    if (claims.compression > 3) refuse(cursor.file, "only the compressions NONE, RLE, ZIPS and ZIP are read");
}

// A name of `type` that is there once; other attributes with that name are refused.
void expect_type(std::string_view name, std::string_view type, std::string_view expected, bool& seen,
                 const std::string& file) {
    if (type != expected) refuse(file, "the attribute " + std::string(name) + " has the wrong type");
    if (seen) refuse(file, "the attribute " + std::string(name) + " is there twice");
    seen = true;
}

void check_flags(Cursor& cursor) {
    if (cursor.left.size() < 8 || cursor.integer() != 20000630) refuse(cursor.file, "this is not an OpenEXR file");
    const uint32_t version = static_cast<uint32_t>(cursor.integer());
    if ((version & 0xff) != 2) refuse(cursor.file, "an OpenEXR version other than 2");
    if (version & deep_flag) refuse(cursor.file, "deep images are not read");
    if (version & multipart_flag) refuse(cursor.file, "files of several parts are not read");
    if (version & tiled_flag) refuse(cursor.file, "tiled images are not read");
    if (version & ~(0xffu | long_names_flag)) refuse(cursor.file, "the header has unknown flags");
}

// The pixels must fit in memory, and no compression may have made the file as small as it is if it is too small.
void check_amount(const ExrClaims& claims, uint64_t file_bytes, const std::string& file) {
    const ivec2 size = claims.high - claims.low + 1;
    if (size.x > largest_side || size.y > largest_side) refuse(file, "the image is larger than 16384 x 16384 pixels");
    const uint64_t pixels = static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y);
    if (pixels * static_cast<uint64_t>(claims.channels) * sizeof(float) > max_decoded_bytes)
        refuse(file, "the image would need more than 4 GiB of memory");
    if (pixels * claims.bytes_per_pixel / best_ratio > file_bytes)
        refuse(file, "the file is too short for its image: cut off or damaged");
}

// Bytes that run lengths stand for (OpenEXR's RLE: a count of -n is followed by n bytes, of n by one to repeat n + 1
// times); nothing where they end early.
std::optional<uint64_t> unpacked_run_lengths(std::string_view packed) {
    uint64_t result = 0;
    for (size_t i = 0; i < packed.size();) {
        const int count = static_cast<signed char>(packed[i++]);
        const size_t follow = count < 0 ? static_cast<size_t>(-count) : 1;
        if (follow > packed.size() - i) return {};
        i += follow, result += count < 0 ? follow : static_cast<size_t>(count) + 1;
    }
    return result;
}

std::optional<uint64_t> unpacked_zip(std::string_view packed, std::vector<unsigned char>& room) {
    uLongf size = room.size();
    const auto* bytes = reinterpret_cast<const unsigned char*>(packed.data());
    if (uncompress(room.data(), &size, bytes, packed.size()) != Z_OK) return {};
    return size;
}

// Every block of lines is where the table says, is the one that belongs there and holds all its pixels. The library
// fills gaps with what memory happens to hold.
void check_blocks(Cursor cursor, const ExrClaims& claims, std::string_view file) {
    const uint64_t height = static_cast<uint64_t>(claims.high.y) - claims.low.y + 1;
    const uint64_t width = static_cast<uint64_t>(claims.high.x) - claims.low.x + 1;
    const uint64_t lines = claims.compression == zip_blocks ? 16 : 1;
    std::vector<unsigned char> room(std::min(lines, height) * width * claims.bytes_per_pixel);
    for (uint64_t line = 0; line < height; line += lines) {
        const uint64_t offset = cursor.number<uint64_t>();
        const std::string name = "the block at line " + std::to_string(claims.low.y + static_cast<int64_t>(line));
        if (offset >= file.size()) refuse(cursor.file, name + " is missing: cut off or damaged");
        Cursor block{file.substr(offset), cursor.file};
        const int32_t first = block.integer(), size = block.integer();
        const uint64_t whole = std::min(lines, height - line) * width * claims.bytes_per_pixel;
        const bool fits = size > 0 && static_cast<uint64_t>(size) <= std::min<uint64_t>(whole, block.left.size());
        if (first != claims.low.y + static_cast<int64_t>(line) || !fits) refuse(cursor.file, name + " is damaged");

        const std::string_view packed = block.bytes(static_cast<size_t>(size));
        std::optional<uint64_t> unpacked = packed.size(); // what does not get smaller is stored as it is
        if (packed.size() < whole && claims.compression == run_lengths) unpacked = unpacked_run_lengths(packed);
        if (packed.size() < whole && claims.compression >= zip_lines) unpacked = unpacked_zip(packed, room);
        if (unpacked != whole) refuse(cursor.file, name + " is damaged");
    }
}
}

ExrClaims check_exr_claims(std::string_view bytes, const std::string& file) {
    Cursor cursor{bytes, file};
    check_flags(cursor);

    ExrClaims claims;
    bool channels = false, window = false, display = false, compression = false;
    for (int count = 0;; ++count) {
        const std::string_view name = cursor.name();
        if (name.empty()) break;
        if (count == max_attributes) refuse(file, "the header has more than 4096 attributes");
        const std::string_view type = cursor.name();
        const int32_t size = cursor.integer();
        if (size < 0) refuse(file, "an attribute has a negative size");
        const Cursor value{cursor.bytes(static_cast<size_t>(size)), file};

        if (name == "channels") {
            expect_type(name, type, "chlist", channels, file);
            read_channels(value, claims);
        } else if (name == "dataWindow") {
            expect_type(name, type, "box2i", window, file);
            read_window(value, claims.low, claims.high);
        } else if (name == "displayWindow") {
            expect_type(name, type, "box2i", display, file);
            read_window(value, claims.display_low, claims.display_high);
        } else if (name == "compression") {
            expect_type(name, type, "compression", compression, file);
            read_compression(value, claims);
        } else if (name == "type" && value.left != "scanlineimage") {
            refuse(file, "only scanline images are read");
        }
    }
    if (!channels || !window || !display || !compression)
        refuse(file, "the header lacks channels, dataWindow, displayWindow or compression");
    check_amount(claims, bytes.size(), file);
    check_blocks(cursor, claims, bytes);
    return claims;
}
}

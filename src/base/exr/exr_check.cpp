#include "base/exr/exr_check.h"

#include "base/exr/exr_cursor.h"
#include "base/exr/exr_file.h"

#include <algorithm>
#include <array>
#include <optional>

namespace tyndall {
namespace {
constexpr int largest_side = 16384, largest_tile = 4096, max_attributes = 4096, max_parts = 256;
constexpr int largest_coordinate = 1 << 24;
constexpr uint64_t largest_tile_bytes = uint64_t{1} << 28;

constexpr std::array<std::string_view, 10> compression_names = {"none",  "rle", "zips", "zip",  "piz",
                                                                "pxr24", "b44", "b44a", "dwaa", "dwab"};

enum : uint32_t { tiled_flag = 0x200, long_names_flag = 0x400, deep_flag = 0x800, multipart_flag = 0x1000 };

// Upper bound on the compression ratio: deflate reaches 1032, and DWA can first reduce 64 values to one.
uint64_t best_ratio(ExrCompression compression) { return compression >= ExrCompression::dwaa ? 64 * 1032 : 2 * 1032; }

void read_channels(ExrCursor cursor, ExrPartHeader& claims) {
    for (std::string_view name; !(name = cursor.name()).empty();) {
        const int type = cursor.integer();
        cursor.bytes(4); // perceptual flag, reserved
        const int step_x = cursor.integer(), step_y = cursor.integer();
        if (type < 0 || type > 2) refuse(cursor.file, "a channel has an unknown pixel type");
        if (step_x != step_y || (step_x != 1 && step_x != 2))
            refuse(cursor.file, "channel subsampling must be 1 or 2, the same in x and y");
        claims.channels.push_back({std::string(name), type == 1 ? 2 : 4, step_x});
        if (claims.channels.size() > max_channels) refuse(cursor.file, "more than 1024 channels");
    }
    if (claims.channels.empty()) refuse(cursor.file, "the header lists no channels");
}

void read_window(ExrCursor cursor, ivec2& low, ivec2& high) {
    if (cursor.left.size() != 16) refuse(cursor.file, "a window has the wrong size");
    low.x = cursor.integer(), low.y = cursor.integer(), high.x = cursor.integer(), high.y = cursor.integer();
    for (const int c : {low.x, low.y, high.x, high.y})
        if (c < -largest_coordinate || c > largest_coordinate) refuse(cursor.file, "a window is out of range");
    if (low.x > high.x || low.y > high.y) refuse(cursor.file, "a window is empty");
}

void read_compression(ExrCursor cursor, ExrPartHeader& claims) {
    const auto number = static_cast<unsigned char>(cursor.bytes(1)[0]);
    if (number >= compression_names.size()) refuse(cursor.file, "unknown compression");
    claims.compression = static_cast<ExrCompression>(number);
}

void read_tiles(ExrCursor cursor, ExrPartHeader& claims) {
    claims.tile.x = cursor.integer(), claims.tile.y = cursor.integer();
    if (claims.tile.x < 1 || claims.tile.y < 1) refuse(cursor.file, "the tiles are empty");
    if (claims.tile.x > largest_tile || claims.tile.y > largest_tile)
        refuse(cursor.file, "the tiles are larger than 4096 x 4096 pixels");
}

// ITU-R BT.709 primaries and white point as x, y; the tolerance allows for files that round to two digits.
bool are_rec709(ExrCursor cursor) {
    constexpr float expected[] = {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f};
    for (const float value : expected)
        if (!(std::abs(cursor.number<float>() - value) < .006f)) return false;
    return true;
}

// Attributes that may occur only once and with one type; anything else under these names is refused.
struct ExpectedAttributes {
    enum Kind { channels, data_window, display_window, compression, tiles, kinds };
    static constexpr std::array<std::pair<std::string_view, std::string_view>, kinds> names = {
        {{"channels", "chlist"},
         {"dataWindow", "box2i"},
         {"displayWindow", "box2i"},
         {"compression", "compression"},
         {"tiles", "tiledesc"}}};
    std::array<bool, kinds> seen{};

    std::optional<Kind> take(std::string_view name, std::string_view type, const std::string& file) {
        for (int kind = 0; kind < kinds; ++kind) {
            if (name != names[kind].first) continue;
            if (type != names[kind].second) refuse(file, "the attribute " + std::string(name) + " has the wrong type");
            if (seen[kind]) refuse(file, "the attribute " + std::string(name) + " appears twice");
            seen[kind] = true;
            return static_cast<Kind>(kind);
        }
        return {};
    }
};

void read_expected(ExpectedAttributes::Kind kind, ExrCursor value, ExrPartHeader& claims) {
    switch (kind) {
    case ExpectedAttributes::channels:
        return read_channels(value, claims);
    case ExpectedAttributes::data_window:
        return read_window(value, claims.low, claims.high);
    case ExpectedAttributes::display_window:
        return read_window(value, claims.display_low, claims.display_high);
    case ExpectedAttributes::compression:
        return read_compression(value, claims);
    case ExpectedAttributes::tiles:
        return read_tiles(value, claims);
    case ExpectedAttributes::kinds:
        return;
    }
}

// The remaining attributes that affect how the part is read.
void read_other(std::string_view name, ExrCursor value, bool multipart, ExrPartHeader& claims) {
    if (name == "type") {
        if (value.left != "scanlineimage" && value.left != "tiledimage")
            refuse(value.file, "only scanline and tiled images are supported");
        if (multipart) claims.tiled = value.left == "tiledimage";
    } else if (name == "chunkCount") {
        claims.chunks = static_cast<uint32_t>(value.integer());
    } else if (name == "envmap") {
        claims.cube = value.bytes(1)[0] == 1;
    } else if (name == "chromaticities") {
        claims.foreign_primaries = !are_rec709(value);
    }
}

// The pixels must fit in memory, and the file must be at least as large as the best compression ratio allows.
void check_amount(const ExrPartHeader& claims, uint64_t file_bytes, const std::string& file) {
    const ivec2 size = claims.high - claims.low + 1;
    if (size.x > largest_side || size.y > largest_side) refuse(file, "the image is larger than 16384 x 16384 pixels");
    const uint64_t pixels = static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y);
    if (pixels * claims.channels.size() * sizeof(float) > max_decoded_bytes)
        refuse(file, "the image would need more than 4 GiB of memory");
    uint64_t bytes_per_pixel = 0, bytes = 0;
    for (const ExrChannelClaim& channel : claims.channels) {
        bytes_per_pixel += static_cast<uint64_t>(channel.bytes);
        bytes += pixels * static_cast<uint64_t>(channel.bytes) / static_cast<uint64_t>(channel.step * channel.step);
    }
    if (bytes / best_ratio(claims.compression) > file_bytes)
        refuse(file, "the file is too short for its image: truncated or damaged");
    if (!claims.tiled) return;
    if (static_cast<uint64_t>(claims.tile.x) * static_cast<uint64_t>(claims.tile.y) * bytes_per_pixel >
        largest_tile_bytes)
        refuse(file, "a tile would need more than 256 MiB of memory");
    const ivec2 tiles = (size + claims.tile - 1) / claims.tile;
    if (static_cast<uint64_t>(tiles.x) * static_cast<uint64_t>(tiles.y) > file_bytes / sizeof(uint64_t))
        refuse(file, "the file is too short for its tiles: truncated or damaged");
}

// Reads one part's header. Returns false at the end of the headers of a multipart file.
bool read_header(ExrCursor& cursor, uint32_t flags, ExrPartHeader& claims) {
    const bool multipart = flags & multipart_flag;
    claims.tiled = flags & tiled_flag;
    ExpectedAttributes expected;
    for (int count = 0;; ++count) {
        const std::string_view name = cursor.name();
        if (name.empty() && count == 0 && multipart) return false;
        if (name.empty()) break;
        if (count == max_attributes) refuse(cursor.file, "the header has more than 4096 attributes");
        const std::string_view type = cursor.name();
        const int32_t size = cursor.integer();
        if (size < 0) refuse(cursor.file, "an attribute has a negative size");
        const ExrCursor value{cursor.bytes(static_cast<size_t>(size)), cursor.file};
        if (const auto kind = expected.take(name, type, cursor.file))
            read_expected(*kind, value, claims);
        else
            read_other(name, value, multipart, claims);
    }
    for (int kind = 0; kind < ExpectedAttributes::tiles; ++kind)
        if (!expected.seen[kind])
            refuse(cursor.file, "the header lacks channels, dataWindow, displayWindow or compression");
    if (claims.tiled && !expected.seen[ExpectedAttributes::tiles]) refuse(cursor.file, "the header lacks tiles");
    return true;
}

uint32_t read_flags(ExrCursor& cursor) {
    if (cursor.left.size() < 8 || cursor.integer() != 20000630) refuse(cursor.file, "this is not an OpenEXR file");
    const uint32_t version = static_cast<uint32_t>(cursor.integer());
    if ((version & 0xff) != 2) refuse(cursor.file, "unsupported OpenEXR version; only version 2 is supported");
    if (version & deep_flag) refuse(cursor.file, "deep images are not supported");
    if (version & ~(0xffu | tiled_flag | long_names_flag | multipart_flag))
        refuse(cursor.file, "the header has unknown flags");
    if ((version & multipart_flag) && (version & tiled_flag))
        refuse(cursor.file, "the header's flags contradict each other");
    return version;
}
}

std::string_view name_of(ExrCompression compression) { return compression_names[static_cast<size_t>(compression)]; }

ExrHeaders read_exr_headers(std::string_view bytes, const std::string& file) {
    ExrCursor cursor{bytes, file};
    const uint32_t flags = read_flags(cursor);
    ExrHeaders claims;
    claims.multipart = flags & multipart_flag;
    for (ExrPartHeader part; read_header(cursor, flags, part); part = {}) {
        check_amount(part, bytes.size(), file);
        if (part.chunks > bytes.size() / sizeof(uint64_t))
            refuse(file, "the file is too short for its blocks: truncated or damaged");
        claims.parts.push_back(std::move(part));
        if (!claims.multipart) break;
        if (claims.parts.size() > max_parts) refuse(file, "more than 256 parts");
    }
    if (claims.parts.empty()) refuse(file, "the file has no parts");
    claims.tables = bytes.size() - cursor.left.size();
    return claims;
}
}

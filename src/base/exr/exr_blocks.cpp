#include "base/exr/exr_check.h"
#include "base/exr/exr_cursor.h"

#include <zlib.h>

#include <algorithm>
#include <optional>

namespace tyndall {
namespace {
// Scanlines per block.
int lines_of(ExrCompression compression) {
    constexpr int lines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return lines[static_cast<size_t>(compression)];
}

// Decoded size of RLE data in bytes (OpenEXR: a count of -n is followed by n literal bytes, a count of n by one byte to
// repeat n + 1 times); nothing if the data are truncated.
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

// Uncompressed bytes of the pixels in the inclusive rectangle from..to.
uint64_t whole_bytes(const ExrPartHeader& part, ivec2 from, ivec2 to) {
    uint64_t bytes = 0;
    for (const ExrChannelClaim& channel : part.channels) {
        const auto values = [&](int first, int last) { // sampled positions (multiples of the step) in first..last
            const auto below = [&](int n) { return static_cast<int>(std::floor(double(n) / channel.step)); };
            return static_cast<uint64_t>(below(last) - below(first - 1));
        };
        bytes += values(from.x, to.x) * values(from.y, to.y) * static_cast<uint64_t>(channel.bytes);
    }
    return bytes;
}

// What is expected of one block of pixels: the fields of its header and its size.
struct ExrBlock {
    std::string name;
    std::vector<int32_t> place; // part number if multipart; then first scanline, or tile and level
    uint64_t whole = 0;         // uncompressed bytes
};

void check_block(ExrCursor& table, std::string_view file, const ExrPartHeader& part, const ExrBlock& expected,
                 std::vector<unsigned char>& room) {
    const uint64_t offset = table.number<uint64_t>();
    if (offset >= file.size()) refuse(table.file, expected.name + " is missing: the file is truncated or damaged");
    ExrCursor block{file.substr(offset), table.file};
    bool belongs = true;
    for (const int32_t number : expected.place) belongs &= block.integer() == number;
    const int32_t size = block.integer();
    const bool fits = size > 0 && static_cast<uint64_t>(size) <= std::min<uint64_t>(expected.whole, block.left.size());
    if (!belongs || !fits) refuse(table.file, expected.name + " is damaged");

    const std::string_view packed = block.bytes(static_cast<size_t>(size));
    if (packed.size() == expected.whole) return; // blocks that do not shrink are stored uncompressed
    std::optional<uint64_t> unpacked = packed.size();
    if (part.compression == ExrCompression::rle) unpacked = unpacked_run_lengths(packed);
    if (part.compression == ExrCompression::zips || part.compression == ExrCompression::zip) {
        room.resize(expected.whole);
        unpacked = unpacked_zip(packed, room);
    }
    if (part.compression <= ExrCompression::zip && unpacked != expected.whole)
        refuse(table.file, expected.name + " is damaged");
}

// Calls visit(block) for each block in offset-table order.
template<class Visit> void visit_lines(const ExrPartHeader& part, std::vector<int32_t> place, const Visit& visit) {
    const int lines = lines_of(part.compression);
    place.push_back(0);
    for (int y = part.low.y; y <= part.high.y; y += lines) {
        const ivec2 from(part.low.x, y), to(part.high.x, std::min(y + lines - 1, part.high.y));
        place.back() = y;
        visit(ExrBlock{"the block at line " + std::to_string(y), place, whole_bytes(part, from, to)});
    }
}

template<class Visit> void visit_tiles(const ExrPartHeader& part, std::vector<int32_t> place, const Visit& visit) {
    const ivec2 tiles = (part.high - part.low + part.tile) / part.tile;
    const size_t first = place.size();
    place.resize(first + 4); // column, row, level in x and y
    for (int y = 0; y < tiles.y; ++y)
        for (int x = 0; x < tiles.x; ++x) {
            const ivec2 from = part.low + ivec2(x, y) * part.tile, to = glm::min(from + part.tile - 1, part.high);
            place[first] = x, place[first + 1] = y;
            visit(ExrBlock{"the tile " + std::to_string(x) + ", " + std::to_string(y), place,
                           whole_bytes(part, from, to)});
        }
}
}

void check_exr_blocks(std::string_view bytes, const ExrHeaders& claims, size_t part, const std::string& file) {
    ExrCursor table{bytes.substr(claims.tables), file};
    for (size_t before = 0; before < part; ++before) table.bytes(claims.parts[before].chunks * sizeof(uint64_t));
    std::vector<int32_t> place;
    if (claims.multipart) place.push_back(static_cast<int32_t>(part));
    std::vector<unsigned char> room;
    const auto check = [&](const ExrBlock& block) { check_block(table, bytes, claims.parts[part], block, room); };
    const ExrPartHeader& chosen = claims.parts[part];
    if (chosen.tiled)
        visit_tiles(chosen, place, check);
    else
        visit_lines(chosen, place, check);
}
}

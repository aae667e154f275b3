// What an EXR file claims, checked before the library sees it. For the EXR files of this folder only.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// As files number them.
enum class ExrCompression : uint8_t { none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab };
std::string_view name_of(ExrCompression compression);

struct ExrChannelClaim {
    std::string name;
    int bytes = 4; // of a value
    int step = 1;  // pixels from one value to the next, across and down
};

struct ExrPartClaims {
    ivec2 display_low{0}, display_high{0};
    ivec2 low{0}, high{0}; // data window, both corners included
    ExrCompression compression = ExrCompression::none;
    std::vector<ExrChannelClaim> channels;
    bool tiled = false;
    ivec2 tile{0};
    bool cube = false;              // a picture of all directions as the faces of a cube
    bool foreign_primaries = false; // says that its colours are of other primaries than Rec.709
    uint64_t chunks = 0;            // of files of several parts: entries of its table
};

struct ExrClaims {
    std::vector<ExrPartClaims> parts;
    size_t tables = 0; // bytes before the tables of blocks
    bool multipart = false;
};

// Walks the headers. Throws Error (refused) unless all parts are flat pictures within limits.
ExrClaims read_exr_claims(std::string_view bytes, const std::string& file);

// Walks every block of pixels of a part, of its largest level. Throws Error (refused) unless each is where the tables
// say and belongs there; of NONE, RLE, ZIPS and ZIP also unless it is whole, for the library fills gaps with what
// memory happens to hold.
void check_exr_blocks(std::string_view bytes, const ExrClaims& claims, size_t part, const std::string& file);
}

// What an EXR file's headers claim, checked before the OpenEXR library sees the file. Internal to this folder.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// In the numbering of the file format.
enum class ExrCompression : uint8_t { none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab };
std::string_view name_of(ExrCompression compression);

struct ExrChannelClaim {
    std::string name;
    int bytes = 4; // per value
    int step = 1;  // subsampling: pixels between values, in x and y
};

struct ExrPartHeader {
    ivec2 display_low{0}, display_high{0};
    ivec2 low{0}, high{0}; // data window, inclusive
    ExrCompression compression = ExrCompression::none;
    std::vector<ExrChannelClaim> channels;
    bool tiled = false;
    ivec2 tile{0};
    bool cube = false;              // environment map stored as cube faces
    bool foreign_primaries = false; // the header states primaries other than Rec.709
    uint64_t chunks = 0;            // entries in its offset table; multipart files only
};

struct ExrHeaders {
    std::vector<ExrPartHeader> parts;
    size_t tables = 0; // byte offset of the block offset tables
    bool multipart = false;
};

// Walks the headers. Throws Error (refused) unless all parts are flat (not deep) images within the limits.
ExrHeaders read_exr_headers(std::string_view bytes, const std::string& file);

// Walks every pixel block of a part at its largest level. Throws Error (refused) unless each block is where the offset
// table says and carries the right coordinates; for NONE, RLE, ZIPS and ZIP also unless it decodes to its full size,
// because the library leaves missing pixels uninitialized.
void check_exr_blocks(std::string_view bytes, const ExrHeaders& claims, size_t part, const std::string& file);
}

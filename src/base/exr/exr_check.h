// What an EXR file claims, checked before the library sees it. For the EXR files of this folder only.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace tyndall {
struct ExrClaims {
    ivec2 display_low{0}, display_high{0};
    ivec2 low{0}, high{0}; // data window, both corners included
    int compression = 0;   // 0 none, 1 RLE, 2 ZIPS, 3 ZIP
    int channels = 0;
    uint64_t bytes_per_pixel = 0;
};

// Walks the header and every block of pixels. Throws Error (refused) unless the file is a flat, single-part scanline
// picture of a supported compression, within limits, and whole.
ExrClaims check_exr_claims(std::string_view bytes, const std::string& file);
}

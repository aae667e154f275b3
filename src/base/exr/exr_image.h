// RGB images from OpenEXR files of any program: environments, gobos, backgrounds.
#pragma once
#include "base/image.h"

#include <string>
#include <string_view>

namespace tyndall {
struct ExrImage {
    ivec2 display{0}, low{0};       // size of the display window; origin of the data window within it
    Image<vec3> color;              // of the data window; Y in all three components for gray files
    bool foreign_primaries = false; // the header states primaries other than Rec.709
};

// Size of the display window of the first part with color channels, from the header alone. Throws Error (refused)
// naming `where`.
ivec2 exr_display_size(std::string_view bytes, const std::string& where);

// Decodes R, G and B, luminance and chroma (as half floats), or Y from the first part that has them; any compression,
// scanlines or the largest level of tiles. Throws Error (refused) naming `where` if no part has such channels or the
// file is deep, a cube map, damaged or over the limits.
ExrImage decode_exr_image(std::string_view bytes, const std::string& where);
}

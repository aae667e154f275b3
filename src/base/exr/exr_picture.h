// OpenEXR pictures by any program, as colours: environments, gobos, backgrounds.
#pragma once
#include "base/image.h"

#include <string>
#include <string_view>

namespace tyndall {
struct ExrPicture {
    ivec2 display{0}, low{0};       // display window's size; first pixel of the data window within it
    Image<vec3> color;              // of the data window; of grey files Y thrice
    bool foreign_primaries = false; // the file says that its colours are of others than Rec.709
};

// Size of the display window of the part that has colours, from the header alone. Throws Error (refused) naming
// `where`.
ivec2 exr_display_size(std::string_view bytes, const std::string& where);

// R, G and B, luminance and chroma (in half floats) or Y, of any compression, of lines or the largest level of tiles,
// of the first part that has them. Throws Error (refused) naming `where`: none of these, deep, a cube, damaged, over
// limits.
ExrPicture decode_exr_picture(std::string_view bytes, const std::string& where);
}

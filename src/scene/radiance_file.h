// Radiance pictures (.hdr, .pic): Ward 1991, "Real Pixels"; the format as Radiance's own documentation has it.
#pragma once
#include "base/image.h"

#include <string>
#include <string_view>

namespace tyndall {
bool is_radiance(std::string_view bytes); // by its first bytes

// Upright, whichever way its lines run. Throws Error (refused) naming `where`.
ivec2 radiance_size(std::string_view bytes, std::string_view where);

// Pixels as they are seen upright, plain or run-length encoded in either way, over the EXPOSURE and COLORCORR that they
// were multiplied by, of which `note` tells. Throws Error (refused) naming `where`, also of a file that is cut off.
Image<vec3> decode_radiance(std::string_view bytes, std::string_view where, std::string& note);
}

// Radiance pictures (.hdr, .pic): Ward 1991, "Real Pixels"; the format as Radiance's own documentation has it.
#pragma once
#include "base/image.h"

#include <string>
#include <string_view>

namespace tyndall {
bool is_radiance(std::string_view bytes); // by its first bytes

// Of the upright picture. Throws Error (refused) naming `where`.
ivec2 radiance_size(std::string_view bytes, std::string_view where);

// Upright pixels, divided by the EXPOSURE and COLORCORR of the header, which `note` says; plain or in either run-length
// encoding. Throws Error (refused) naming `where`, also for a file that is cut off.
Image<vec3> decode_radiance(std::string_view bytes, std::string_view where, std::string& note);
}

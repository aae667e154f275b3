// Radiance images (.hdr, .pic): Ward 1991, "Real Pixels"; the format follows Radiance's own documentation.
#pragma once
#include "base/image.h"

#include <string>
#include <string_view>

namespace tyndall {
bool is_radiance(std::string_view bytes); // by its first bytes

// Size of the upright image. Throws Error (refused) naming `where`.
ivec2 radiance_size(std::string_view bytes, std::string_view where);

// Decodes uncompressed pixels or either run-length encoding to an upright image, divided by the header's EXPOSURE and
// COLORCORR, which `note` reports. Throws Error (refused) naming `where`, also if the file is truncated.
Image<vec3> decode_radiance(std::string_view bytes, std::string_view where, std::string& note);
}

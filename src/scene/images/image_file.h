// Decodes PNG, JPEG, Radiance and OpenEXR images to linear light. The only user of stb_image.
#pragma once
#include "scene/images/texels.h"

#include <string>
#include <string_view>

namespace tyndall {
inline constexpr int largest_image_side = 16384;

enum class ImageFormat { png, jpeg, radiance, openexr, other };

// Detected from the first bytes, never from the name.
ImageFormat image_format(std::string_view bytes);

// Size from the header alone. Throws Error (refused) naming `where` when there is none or a side is over the limit.
ivec2 image_size(std::string_view bytes, std::string_view where);

// A PNG or JPEG of sRGB colors of 8 or 16 bits. Throws Error (refused) naming `where`.
Texels decode_texture(std::string_view bytes, std::string_view where);

// Decodes an image for backgrounds: sRGB PNG or JPEG, Radiance .hdr or OpenEXR (its display window, black where there
// are no pixels). Negative values are set to 0. `note` reports these, primaries other than Rec.709, and an image that
// is all black. Throws Error (refused) naming `where`.
Image<vec3> decode_image(std::string_view bytes, std::string_view where, std::string& note);

// An image reduced by an integer factor, each texel the mean of a block; blocks at the right and lower edge may extend
// past the image, where it is black.
struct ReducedImage {
    ivec2 size{0}; // of the file
    int factor = 1;
    Image<vec3> image;
};

// Decodes the formats of decode_image() at reduced size; with `linear`, PNG and JPEG values are linear. Sides are at
// most `largest` in the file (float formats: half of that) and `most` in the result. Throws Error (refused) naming
// `where`.
ReducedImage decode_reduced(std::string_view bytes, bool linear, int largest, int most, std::string_view where,
                            std::string& note);
}

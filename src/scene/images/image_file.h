// PNG, JPEG, Radiance and OpenEXR pictures as linear light. The only user of stb_image.
#pragma once
#include "base/image.h"

#include <string>
#include <string_view>

namespace tyndall {
inline constexpr int largest_image_side = 16384;

enum class ImageFormat { png, jpeg, radiance, openexr, other };

// Told from the first bytes, never from the name.
ImageFormat image_format(std::string_view bytes);

// Size from the header alone. Throws Error (refused) naming `where` when there is none or a side is over the limit.
ivec2 image_size(std::string_view bytes, std::string_view where);

// sRGB bytes to linear colour, alpha as it is. Throws Error (refused) naming `where`.
Image<vec4> decode_texture(std::string_view bytes, std::string_view where);

// A picture behind the scene: sRGB PNG or JPEG, Radiance .hdr or OpenEXR, whose display window it fills, black where
// there are no pixels. Negative light is set to 0, of which `note` tells, as of colours that are of other primaries,
// and of a picture without light. Throws Error (refused) naming `where`.
Image<vec3> decode_picture(std::string_view bytes, std::string_view where, std::string& note);

// A picture whose sides were divided by a whole number, each texel the mean of a block; blocks at the right and lower
// edge may stick out of the picture, where it is black.
struct ReducedPicture {
    ivec2 size{0}; // of the file
    int factor = 1;
    Image<vec3> image;
};

// As decode_picture(); `linear`: numbers of PNG and JPEG are light as they are. Sides are at most `largest` in the file
// (of floats: half of that) and `most` afterwards. Throws Error (refused) naming `where`.
ReducedPicture decode_reduced(std::string_view bytes, bool linear, int largest, int most, std::string_view where,
                              std::string& note);

// Half the size, each texel the mean of four (alpha-weighted colour); odd edges repeat their last texel.
Image<vec4> halved(const Image<vec4>& image);
}

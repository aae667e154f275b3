// Gobos: images that spots project and that texture rectangles.
#pragma once
#include "base/math.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
template<class T> struct Image;

// Encoding of an image's values: sRGB, or linear in light.
enum class ColorSpace { srgb, linear };

struct Gobo {
    // A mip level: planar texels, row by row from the upper left, with a black border of one texel.
    struct Level {
        ivec2 size{0}; // including the border
        vec2 texels;   // size of the image without the border; fractional where the last texels extend past it
        std::vector<float> values;
        const float* plane(int index) const { return values.data() + static_cast<size_t>(index) * size.x * size.y; }
    };
    std::string content; // hash of the file
    std::string file;    // of a sequence: the path, size and time of the image
    int planes = 1;      // 3 if colored
    float aspect = 1;    // height over width
    std::vector<Level> levels;
};

inline constexpr int largest_gobo_side = 8192, reduced_gobo_side = 2048;
inline constexpr uint64_t largest_gobo_file = uint64_t{1} << 28; // bytes

// Decodes a PNG, JPEG, Radiance .hdr or OpenEXR; transparent parts are black. Images over reduced_gobo_side are
// box-filtered down to it, which `note` reports. Throws Error (refused) naming `where` if the image is damaged or over
// largest_gobo_side.
std::shared_ptr<Gobo> make_gobo(std::string_view bytes, ColorSpace space, std::string_view where, std::string& note);

// From an image in memory.
std::shared_ptr<Gobo> make_gobo(const Image<vec3>& image);

// Bilinear color at (u, v), 0..1 from the upper left; black outside.
dvec3 gobo_at(const Gobo& gobo, double u, double v);

// The mip level for lookups spaced this fraction of the image's width apart: its texels are at least half that wide.
int gobo_level(const Gobo& gobo, float share);
}

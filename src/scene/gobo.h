// Pictures that spots project and rectangles show: what of their light goes where.
#pragma once
#include "base/math.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
template<class T> struct Image;

// How the numbers of a picture stand for light: as the sRGB curve has it, or in proportion.
enum class ColorSpace { srgb, linear };

struct Gobo {
    // Halved again and again; texels of planes one after the other, row by row from the upper left, with a black border
    // of one texel.
    struct Level {
        ivec2 size{0}; // with the border
        vec2 texels;   // of the picture, without; the last ones may stick out of it
        std::vector<float> values;
        const float* plane(int index) const { return values.data() + static_cast<size_t>(index) * size.x * size.y; }
    };
    std::string content; // hash of the file
    std::string file;    // of one of a sequence: which it was, and of when
    int planes = 1;      // 3 where it has colours
    float aspect = 1;    // height over width
    std::vector<Level> levels;
};

inline constexpr int largest_gobo_side = 8192, reduced_gobo_side = 2048;
inline constexpr uint64_t largest_gobo_file = uint64_t{1} << 28; // bytes

// PNG, JPEG, Radiance .hdr or OpenEXR; transparent parts are black. Pictures over reduced_gobo_side are averaged down
// to it, which `note` then says. Throws Error (refused) naming `where`: damaged, or over largest_gobo_side.
std::shared_ptr<Gobo> make_gobo(std::string_view bytes, ColorSpace space, std::string_view where, std::string& note);

// One made in memory.
std::shared_ptr<Gobo> make_gobo(const Image<vec3>& image);

// Colour at a place of the picture, 0..1 from the upper left; black outside.
dvec3 gobo_at(const Gobo& gobo, double u, double v);

// The level for looks that are this share of the picture's width apart: its texels are half as wide, or wider.
int gobo_level(const Gobo& gobo, float share);
}

// Maps of error as pictures for looking at.
#pragma once
#include "base/image.h"

namespace tyndall {
using Color8 = glm::u8vec3; // sRGB

// 0 black, 1 white, brightness even in between and rising, so that the map reads the same for colour-blind eyes and in
// print: cubehelix (Green 2011), through violet, rose and sand.
Color8 heat_color(double t);

// The values of a map from `low` (black) to `high` (white); logarithmic when `log`, with low > 0. NaN is bright green,
// which the scale does not have. A strip of the whole scale, rising from left to right, lies below the picture.
Image<Color8> heat_map(const Image<float>& values, double low, double high, bool log);
inline constexpr int heat_strip_height(int width) { return std::max(4, width / 40); }

// Root of the mean square of the channels' differences at each pixel, divided by the reference's mean; NaN where a
// pixel is not finite in either picture.
Image<float> error_map(const Image<vec3>& test, const Image<vec3>& reference, double mean_reference);
}

// Pixel reconstruction filters as separable densities, the same in x and y.
#pragma once
#include "base/math.h"

namespace tyndall {
enum class PixelFilter { box, tent, gaussian, blackman_harris, center };

// A point of the square [-1,1]², distributed as the filter, from numbers in [0,1). Zero for `center`.
vec2 filter_point(PixelFilter filter, vec2 u);

// Density of filter_point() at a point; 0 outside the square. Not for `center`.
float filter_density(PixelFilter filter, vec2 point);
}

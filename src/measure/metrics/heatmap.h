// Maps of error as pictures for looking at.
#pragma once
#include "base/image.h"

namespace tyndall {
using Color8 = glm::u8vec3; // sRGB

// 0 black, 1 white, lightness rising evenly in between, so that the map reads the same for colour-blind eyes and in
// print: cubehelix (Green 2011), through violet, rose and sand.
Color8 heat_color(double t);

// The values that a heat map shows from black to white.
struct HeatScale {
    double low = 0, high = 1;
    bool logarithmic = false; // low and high are powers of ten then
};

// Where a value lies on the scale: 0 black, 1 white. And its colour; NaN is bright green, which the scale does not
// have.
double heat_place(double value, const HeatScale& scale);
Color8 heat_color(double value, const HeatScale& scale);

// Each value in its colour. Below lies a strip with the scale,
// black to white, and where there is room its values in figures.
Image<Color8> heat_map(const Image<float>& values, const HeatScale& scale);
int heat_strip_height(int width);

// Root of the mean square of the channels' differences at each pixel, divided by the reference's mean; NaN where a
// pixel is not finite in either picture.
Image<float> error_map(const Image<vec3>& test, const Image<vec3>& reference, double mean_reference);
}

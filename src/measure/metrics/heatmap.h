// Error maps as color images.
#pragma once
#include "base/image.h"

namespace tyndall {
using Color8 = glm::u8vec3; // sRGB

// Color map from black (0) to white (1) with evenly rising lightness, so that it reads the same with color vision
// deficiency and in print: cubehelix (Green 2011), through violet, rose and sand.
Color8 heat_color(double t);

// The values that a heat map shows from black to white.
struct HeatScale {
    double low = 0, high = 1;
    bool logarithmic = false; // requires powers of ten as low and high
};

// A value's place on the scale, black (0) to white (1), and its color; NaN is bright green, which is not on the scale.
double heat_place(double value, const HeatScale& scale);
Color8 heat_color(double value, const HeatScale& scale);

// Each value in its color, above a strip with the scale from black to white, labeled where there is room.
Image<Color8> heat_map(const Image<float>& values, const HeatScale& scale);
int heat_strip_height(int width);

// Root mean square of the channels' differences at each pixel, divided by the reference's mean; NaN where a pixel is
// not finite in either image.
Image<float> error_map(const Image<vec3>& test, const Image<vec3>& reference, double mean_reference);
}

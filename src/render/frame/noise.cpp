#include "render/frame/noise.h"

#include <algorithm>
#include <limits>

namespace tyndall {
namespace {
constexpr double confidence = 1.96; // standard deviations below which 97.5 % of a normal distribution lie
constexpr int largest_tile = 8, fewest_tiles = 16;

double channel_mean(vec3 value) { return (double{value.x} + value.y + value.z) / 3; }

int tiles_across(int length, int side) { return (length + side - 1) / side; }

double mean_of(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3& value : image.pixels) sum += channel_mean(value);
    return sum / static_cast<double>(image.pixels.size());
}

// Standard error of an image's mean from the means of its square tiles. What differs between tiles for another reason
// than chance makes it larger.
double standard_error(const Image<vec3>& image, double mean) {
    int side = largest_tile;
    while (side > 1 && tiles_across(image.size.x, side) * tiles_across(image.size.y, side) < fewest_tiles) side /= 2;
    const ivec2 tiles(tiles_across(image.size.x, side), tiles_across(image.size.y, side));
    const int count = tiles.x * tiles.y;
    if (count < 2) return 0;

    std::vector<double> excess(static_cast<size_t>(count), 0.0); // of each tile's sum over what the mean makes expect
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x)
            excess[static_cast<size_t>(y / side * tiles.x + x / side)] += channel_mean(image.at(x, y)) - mean;
    double squares = 0;
    for (const double value : excess) squares += value * value;
    return std::sqrt(squares * count / (count - 1)) / static_cast<double>(image.pixels.size());
}

Noise noise_of(const Image<vec3>& picture, const Image<vec3>& variances, int freedom) {
    const double mean = mean_of(picture), variance = mean_of(variances);
    if (!(variance > 0)) return {};
    if (!(mean > 0)) return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

    // At best the variances are as well known as those of normal distributions, with channels that agree.
    const double best = variance * std::sqrt(2.0 / (freedom * static_cast<double>(picture.pixels.size())));
    const double high = variance + confidence * std::max(standard_error(variances, variance), best);
    return {std::sqrt(variance) / mean, std::sqrt(high) / mean};
}
}

Noise noise_of(const Layers& layers, int freedom) {
    const Noise color = noise_of(layers.color, layers.variance, freedom);
    const Noise fog = noise_of(layers.inscatter, layers.inscatter_variance, freedom);
    return {std::max(color.error, fog.error), std::max(color.bound, fog.bound)};
}
}

#include "render/frame/layers.h"

#include <algorithm>
#include <limits>

namespace tyndall {
namespace {
// Into `image` a share of another one.
template<class T> void blend(Image<T>& image, const Image<T>& other, float share) {
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += share * (other.pixels[i] - image.pixels[i]);
}

// Variance of the blended mean of independent pictures.
void blend_variance(Image<vec3>& variance, const Image<vec3>& other, float share) {
    const float kept = (1 - share) * (1 - share), added = share * share;
    for (size_t i = 0; i < variance.pixels.size(); ++i)
        variance.pixels[i] = kept * variance.pixels[i] + added * other.pixels[i];
}
}

void blend_layers(Layers& layers, const Layers& other, float share) {
    blend(layers.color, other.color, share);
    blend(layers.alpha, other.alpha, share);
    blend(layers.inscatter, other.inscatter, share);
    blend(layers.transmittance, other.transmittance, share);
    blend(layers.validity, other.validity, share);
    blend(layers.half_a, other.half_a, share);
    blend(layers.half_b, other.half_b, share);
    for (size_t i = 0; i < layers.lights.size(); ++i) blend(layers.lights[i].second, other.lights[i].second, share);
    blend_variance(layers.variance, other.variance, share);
    blend_variance(layers.inscatter_variance, other.inscatter_variance, share);
}

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

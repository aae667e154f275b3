#include "render/frame/layers.h"

#include <algorithm>
#include <limits>

namespace tyndall {
namespace {
// Into `image` a share of another one, for each pixel.
template<class T, class Share> void blend(Image<T>& image, const Image<T>& other, const Share& share) {
    if (image.empty()) return;
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x) image.at(x, y) += share({x, y}) * (other.at(x, y) - image.at(x, y));
}

// Variance of the blended mean of independent pictures.
template<class Share> void blend_variance(Image<vec3>& variance, const Image<vec3>& other, const Share& share) {
    for (int y = 0; y < variance.size.y; ++y)
        for (int x = 0; x < variance.size.x; ++x) {
            const float added = share({x, y}), kept = 1 - added;
            variance.at(x, y) = kept * kept * variance.at(x, y) + added * added * other.at(x, y);
        }
}

template<class Share> void blend_all(Layers& layers, const Layers& other, const Share& share) {
    blend(layers.color, other.color, share);
    blend(layers.alpha, other.alpha, share);
    blend(layers.inscatter, other.inscatter, share);
    blend(layers.transmittance, other.transmittance, share);
    blend(layers.validity, other.validity, share);
    blend(layers.half_a, other.half_a, share);
    blend(layers.half_b, other.half_b, share);
    for (size_t i = 0; i < layers.lights.size(); ++i) blend(layers.lights[i].second, other.lights[i].second, share);
    for (const auto part :
         {&Layers::surface, &Layers::background, &Layers::ambient, &Layers::emission, &Layers::multiple})
        blend(layers.*part, other.*part, share);
    add_up(layers);
    blend_variance(layers.variance, other.variance, share);
    blend_variance(layers.inscatter_variance, other.inscatter_variance, share);
}
}

void add_up(Layers& layers) {
    for (size_t i = 0; i < layers.ambient.pixels.size(); ++i) {
        vec3 sum(0);
        for (const auto& [name, light] : layers.lights) sum += light.pixels[i];
        layers.inscatter.pixels[i] =
            sum + layers.ambient.pixels[i] + layers.emission.pixels[i] + layers.multiple.pixels[i];
    }
    for (size_t i = 0; i < layers.surface.pixels.size(); ++i)
        layers.color.pixels[i] = layers.surface.pixels[i] + layers.background.pixels[i] + layers.inscatter.pixels[i];
}

void blend_layers(Layers& layers, const Layers& other, float share) {
    blend_all(layers, other, [share](ivec2) { return share; });
}

void blend_layers(Layers& layers, const Layers& other, const TileShares& shares) {
    constexpr int tile_side = 4;
    blend_all(layers, other, [&](ivec2 p) {
        const ivec2 tile = (layers.low + p) / tile_side - shares.low;
        return shares.shares.at(tile.x, tile.y);
    });
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

// Of an image's mean: its standard error, and how much of it comes in one lump, the third moment over the variance.
struct Spread {
    double error = 0, lump = 0;
};

// From the means of its square tiles. What differs between tiles for another reason than chance makes it larger.
Spread spread_of(const Image<vec3>& image, double mean) {
    int side = largest_tile;
    while (side > 1 && tiles_across(image.size.x, side) * tiles_across(image.size.y, side) < fewest_tiles) side /= 2;
    const ivec2 tiles(tiles_across(image.size.x, side), tiles_across(image.size.y, side));
    const int count = tiles.x * tiles.y;
    if (count < 2) return {};

    std::vector<double> excess(static_cast<size_t>(count), 0.0); // of each tile's sum over what the mean makes expect
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x)
            excess[static_cast<size_t>(y / side * tiles.x + x / side)] += channel_mean(image.at(x, y)) - mean;
    double squares = 0, cubes = 0;
    for (const double value : excess) squares += value * value, cubes += value * value * value;
    const double pixels = static_cast<double>(image.pixels.size());
    return {std::sqrt(squares * count / (count - 1)) / pixels,
            squares > 0 ? std::max(cubes / squares, 0.0) / pixels : 0};
}

Noise noise_of(const Image<vec3>& picture, const Image<vec3>& variances, int freedom) {
    const double mean = mean_of(picture), variance = mean_of(variances);
    if (!(variance > 0)) return {};
    if (!(mean > 0)) return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

    // At best the variances are as well known as those of normal distributions, with channels that agree.
    const double best = variance * std::sqrt(2.0 / (freedom * static_cast<double>(picture.pixels.size())));
    const Spread spread = spread_of(variances, variance);
    const double half = confidence * spread.lump / 2; // Wilson (1927), as for counts of lumps
    const double high = variance + confidence * (half + std::hypot(std::max(spread.error, best), half));
    return {std::sqrt(variance) / mean, std::sqrt(high) / mean};
}
}

Noise noise_of(const Layers& layers, int freedom) {
    const Noise color = noise_of(layers.color, layers.variance, freedom);
    const Noise fog = noise_of(layers.inscatter, layers.inscatter_variance, freedom);
    return {std::max(color.error, fog.error), std::max(color.bound, fog.bound)};
}
}

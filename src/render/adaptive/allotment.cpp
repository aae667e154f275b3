#include "render/adaptive/allotment.h"
#include "trace/view.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr int tile_side = 4;
// A tile spreads at least as this share of the variance beside it, or of the picture's: chance may have hidden it.
constexpr double beside_share = 1.0 / 16, image_share = 1.0 / 256;

double channel_mean(vec3 value) { return (double{value.x} + value.y + value.z) / 3; }

double square_of_mean(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3& value : image.pixels) sum += channel_mean(value);
    const double mean = sum / static_cast<double>(image.pixels.size());
    return mean * mean;
}

// Sums over the pixels of tiles.
struct Tiles {
    ivec2 low{0}, size{0};
    std::vector<double> variance, pixels, work;

    size_t index(ivec2 tile) const { return static_cast<size_t>(tile.y) * size.x + tile.x; }
};

Tiles empty_tiles(const Layers& layers) {
    Tiles tiles{
        layers.low / tile_side, (layers.low + layers.size - 1) / tile_side - layers.low / tile_side + 1, {}, {}, {}};
    tiles.variance.resize(static_cast<size_t>(tiles.size.x) * tiles.size.y, 0.0);
    tiles.pixels = tiles.work = tiles.variance;
    return tiles;
}

// Of the colour and the fog light, each as a share of its own squared mean: enough for both.
Tiles relative_variances(const Layers& layers) {
    const double color = square_of_mean(layers.color), fog = square_of_mean(layers.inscatter);
    Tiles tiles = empty_tiles(layers);
    for (int y = 0; y < layers.size.y; ++y)
        for (int x = 0; x < layers.size.x; ++x) {
            const size_t i = tiles.index((layers.low + ivec2(x, y)) / tile_side - tiles.low);
            const double a = color > 0 ? channel_mean(layers.variance.at(x, y)) / color : 0;
            const double b = fog > 0 ? channel_mean(layers.inscatter_variance.at(x, y)) / fog : 0;
            tiles.variance[i] += std::max(a, b), tiles.pixels[i] += 1;
            tiles.work[i] += layers.work.empty() ? 1 : layers.work.at(x, y);
        }
    return tiles;
}

// Variance of a pixel of each tile, raised to what lies around allows.
std::vector<double> cautious(const Tiles& tiles) {
    double sum = 0, pixels = 0;
    for (size_t i = 0; i < tiles.variance.size(); ++i) sum += tiles.variance[i], pixels += tiles.pixels[i];
    std::vector<double> result(tiles.variance.size());
    for (int y = 0; y < tiles.size.y; ++y)
        for (int x = 0; x < tiles.size.x; ++x) {
            const size_t here = tiles.index({x, y});
            result[here] = std::max(tiles.variance[here] / tiles.pixels[here], image_share * sum / pixels);
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, tiles.size.y - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, tiles.size.x - 1); ++u) {
                    const size_t i = tiles.index({u, v});
                    result[here] = std::max(result[here], beside_share * tiles.variance[i] / tiles.pixels[i]);
                }
        }
    return result;
}

// Of a pixel of each tile, as shares of the mean one's.
std::vector<double> costs_of(const Tiles& tiles, double pixels) {
    double sum = 0;
    for (const double work : tiles.work) sum += work;
    std::vector<double> result(tiles.work.size());
    for (size_t i = 0; i < result.size(); ++i) result[i] = tiles.work[i] / tiles.pixels[i] * pixels / sum;
    return result;
}

float samples_at(double scale, double variance, double power, int least) {
    return static_cast<float>(
        std::clamp(scale * std::pow(variance, 1 / (1 + power)), 1.0 * least, 1.0 * max_tile_samples));
}
}

Allotment allot(const Layers& layers, double taken, const Enough& enough, double power, int least) {
    const Tiles tiles = relative_variances(layers);
    const std::vector<double> variances = cautious(tiles);
    double pixels = 0;
    for (const double count : tiles.pixels) pixels += count;
    const std::vector<double> costs = costs_of(tiles, pixels);
    const auto at = [&](double scale) {
        Allotment result{tiles.low, Image<float>(tiles.size), 0, 0};
        for (size_t i = 0; i < variances.size(); ++i) {
            const float samples = samples_at(scale, variances[i], power, least);
            result.samples.pixels[i] = samples, result.rays += tiles.pixels[i] * costs[i] * samples;
            result.squared_error += tiles.pixels[i] / pixels * variances[i] * std::pow(taken / samples, power);
        }
        return result;
    };

    // The error falls as the scale grows: bisected in its logarithm.
    double low = -60, high = 60;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        const Allotment tried = at(std::exp(middle));
        (tried.squared_error > enough.squared_error && tried.rays < enough.rays ? low : high) = middle;
    }
    return at(std::exp(high));
}

AllottedPart part_of(const Allotment& allotment, double from, double to, int unit) {
    const auto units = [&](double scale, float samples) {
        if (!(scale > 0)) return 0.0;
        const double wanted = scale * samples / unit, step = wanted >= many_allotted ? more_batches : 1;
        return std::clamp(std::ceil(wanted / step) * step, 1.0, 1.0 * max_tile_samples - more_batches);
    };
    auto factors = std::make_shared<TileFactors>();
    AllottedPart part{nullptr, {allotment.low, Image<float>(allotment.samples.size)}};
    factors->low = allotment.low, factors->factors = Image<uint16_t>(allotment.samples.size);
    for (size_t i = 0; i < allotment.samples.pixels.size(); ++i) {
        const float samples = allotment.samples.pixels[i];
        const double all = units(to, samples), added = all - units(from, samples);
        factors->factors.pixels[i] = static_cast<uint16_t>(added);
        part.shares.shares.pixels[i] = static_cast<float>(added / all);
    }
    part.factors = std::move(factors);
    return part;
}
}

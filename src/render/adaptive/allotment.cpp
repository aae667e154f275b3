#include "render/adaptive/allotment.h"
#include "render/frame/layers.h"
#include "trace/view.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// A tile's variance counts as at least these shares of its neighbors' and of the image's mean: few samples may have
// missed it.
constexpr double beside_share = 1.0 / 16, image_share = 1.0 / 2048;

// Share of the squared error from which on tiles that cannot have more samples leave little for others to improve.
constexpr double max_of_full = 0.5;

double square_of_mean(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3& value : image.pixels) sum += channel_mean(value);
    const double mean = sum / static_cast<double>(image.pixels.size());
    return mean * mean;
}

// Effective number of pixels that hold the squared light, as if equally bright.
double bright_pixels(const Image<vec3>& image) {
    double squares = 0, fourths = 0;
    for (const vec3& value : image.pixels) {
        const double square = std::pow(channel_mean(value), 2);
        squares += square, fourths += square * square;
    }
    return fourths > 0 ? squares * squares / fourths : infinity;
}

// Sums over the pixels of each tile.
struct Tiles {
    ivec2 low{0}, size{0};
    std::vector<double> variance, squares, pixels, work; // squares: sums of squared variances

    size_t index(ivec2 tile) const { return static_cast<size_t>(tile.y) * size.x + tile.x; }
};

ivec2 tile_count(const Layers& layers) {
    return (layers.low + layers.size - 1) / tile_side - layers.low / tile_side + 1;
}

Tiles empty_tiles(const Layers& layers) {
    Tiles tiles{layers.low / tile_side, tile_count(layers), {}, {}, {}, {}};
    tiles.variance.resize(static_cast<size_t>(tiles.size.x) * tiles.size.y, 0.0);
    tiles.squares = tiles.pixels = tiles.work = tiles.variance;
    return tiles;
}

// Variances of one sample: the larger of color's and inscatter's, each relative to the layer's squared mean.
Tiles relative_variances(const Layers& layers, const Image<float>& taken, double power) {
    const double color = square_of_mean(layers.color), fog = square_of_mean(layers.inscatter);
    std::vector<double> times(taken.pixels.size()); // the variance of the means of the samples taken
    for (size_t i = 0; i < times.size(); ++i) times[i] = std::pow(double{taken.pixels[i]}, power);
    Tiles tiles = empty_tiles(layers);
    for (int y = 0; y < layers.size.y; ++y)
        for (int x = 0; x < layers.size.x; ++x) {
            const size_t i = tiles.index((layers.low + ivec2(x, y)) / tile_side - tiles.low);
            const double a = color > 0 ? channel_mean(layers.variance.at(x, y)) / color : 0;
            const double b = fog > 0 ? channel_mean(layers.inscatter_variance.at(x, y)) / fog : 0;
            const double variance = std::max(a, b) * times[i];
            tiles.variance[i] += variance, tiles.squares[i] += variance * variance, tiles.pixels[i] += 1;
            tiles.work[i] += layers.work.empty() ? 1 : layers.work.at(x, y);
        }
    return tiles;
}

// Variance per pixel of each tile, raised to a share of its neighbors' and of the image's mean.
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

// Cost per pixel of each tile, relative to the mean pixel's.
std::vector<double> costs_of(const Tiles& tiles, double pixels) {
    double sum = 0;
    for (const double work : tiles.work) sum += work;
    std::vector<double> result(tiles.work.size());
    for (size_t i = 0; i < result.size(); ++i) result[i] = tiles.work[i] / tiles.pixels[i] * pixels / sum;
    return result;
}

// Where an image's error comes from, by tile.
struct Sources {
    std::vector<double> variances, costs, uneven; // per pixel and sample; uneven: mean v² / (mean v)² within the tile
    std::vector<double> pixels;
    double pixel_count = 0, power = 1;

    // Sum of the squared variances of a tile's pixels.
    double squares(size_t i, double variance) const { return pixels[i] * uneven[i] * variance * variance; }
};

Sources sources_of(const Tiles& tiles, double power) {
    Sources sources{cautious(tiles), {}, {}, tiles.pixels, 0, power};
    for (const double count : tiles.pixels) sources.pixel_count += count;
    sources.costs = costs_of(tiles, sources.pixel_count);
    for (size_t i = 0; i < tiles.variance.size(); ++i)
        sources.uneven.push_back(
            tiles.variance[i] > 0 ? tiles.squares[i] * tiles.pixels[i] / std::pow(tiles.variance[i], 2) : 1);
    return sources;
}

// Samples of each tile, up to a common factor, that reach an error bound at the least cost. If few pixels cause most of
// the error, it may far exceed its expected value, so these pixels get more samples than their variance alone suggests:
// each is weighted by what it contributes to mean + z × standard deviation of the squared error.
std::vector<double> shares_of_samples(const Sources& sources) {
    constexpr double deviations = noise_deviations * 1.41421356; // a sum of squared normals has the variance 2 Σ v²
    std::vector<double> shares(sources.variances.size()), variances = shares, weights = sources.variances;
    for (int pass = 0; pass < 12; ++pass) {
        double squares = 0;
        for (size_t i = 0; i < shares.size(); ++i) {
            const double gain = weights[i] / std::max(sources.costs[i], 1e-6);
            shares[i] = std::pow(gain, 1 / (1 + sources.power));
            variances[i] = gain > 0 ? sources.variances[i] * shares[i] / gain : 0; // gain = share^(1 + power)
            squares += sources.squares(i, variances[i]);
        }
        for (size_t i = 0; squares > 0 && i < shares.size(); ++i)
            weights[i] =
                sources.variances[i] * (1 + deviations * sources.uneven[i] * variances[i] / std::sqrt(squares));
    }
    return shares;
}

// Units of samples per pixel of a tile, in an image with `scale` times the allotted samples.
double units_of(double scale, float samples, int unit, bool continues) {
    if (!(scale > 0)) return 0;
    const double wanted = scale * samples / unit, step = wanted >= many_allotted && !continues ? more_batches : 1;
    return std::clamp(std::ceil(wanted / step) * step, 1.0, 1.0 * max_tile_samples - more_batches);
}
}

Allotment allot(const Layers& layers, double taken, const AllotLimits& limits, double power, int least) {
    return allot(layers, uniform_samples(layers, taken), limits, power, least);
}

Allotment allot(const Layers& layers, const Image<float>& taken, const AllotLimits& limits, double power, int least) {
    const Sources sources = sources_of(relative_variances(layers, taken, power), power);
    const std::vector<double> shares = shares_of_samples(sources);
    const double bright = std::min(bright_pixels(layers.color), bright_pixels(layers.inscatter));
    std::vector<double> powers(shares.size());
    for (size_t i = 0; i < shares.size(); ++i) powers[i] = std::pow(shares[i], power);
    const double most = max_tile_samples, of_least = std::pow(least, power), of_most = std::pow(most, power);
    const auto at = [&](double scale) {
        Allotment result{layers.low / tile_side, Image<float>(tile_count(layers))};
        const double of_scale = std::pow(scale, power);
        double sum = 0, squares = 0, of_full = 0; // of_full: of tiles that have the most samples they can
        for (size_t i = 0; i < shares.size(); ++i) {
            const double samples = std::clamp(scale * shares[i], 1.0 * least, most);
            result.samples.pixels[i] = static_cast<float>(samples);
            result.rays += sources.pixels[i] * sources.costs[i] * samples;
            const double variance = sources.variances[i] / std::clamp(of_scale * powers[i], of_least, of_most);
            sum += sources.pixels[i] * variance, squares += sources.squares(i, variance);
            if (samples >= most) of_full += sources.pixels[i] * variance;
        }
        const bool can_improve = of_full < max_of_full * sum;
        result.squared_error = sum / sources.pixel_count;
        const double pixels = squares > 0 ? sum * sum / squares : infinity;
        result.squared_bound = squares > 0 ? result.squared_error * largest_square(pixels) : 0;
        result.pixels = std::min(pixels, bright);
        return std::pair(result, can_improve);
    };

    // The error decreases as the scale grows: bisect the logarithm of the scale.
    double low = -60, high = 60;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        const auto [tried, can_improve] = at(std::exp(middle));
        const bool good = tried.squared_error <= limits.squared_error && tried.squared_bound <= limits.squared_bound;
        (!good && can_improve && tried.rays < limits.rays ? low : high) = middle;
    }
    return at(std::exp(high)).first;
}

Image<float> uniform_samples(const Layers& layers, double samples) {
    return Image<float>(tile_count(layers), static_cast<float>(samples));
}

Image<float> samples_in(const Allotment& allotment, double scale, int unit, bool continues) {
    Image<float> samples = allotment.samples;
    for (float& value : samples.pixels) value = static_cast<float>(unit * units_of(scale, value, unit, continues));
    return samples;
}

AllottedPart allotted_part(const Allotment& allotment, double from, double to, int unit, bool continues) {
    auto factors = std::make_shared<TileFactors>();
    const auto taken = std::make_shared<TileFactors>();
    AllottedPart part{nullptr, nullptr, {allotment.low, Image<float>(allotment.samples.size)}};
    factors->low = allotment.low, factors->factors = Image<uint16_t>(allotment.samples.size);
    *taken = *factors;
    for (size_t i = 0; i < allotment.samples.pixels.size(); ++i) {
        const float samples = allotment.samples.pixels[i];
        const double all = units_of(to, samples, unit, continues), before = units_of(from, samples, unit, continues);
        const double added = all - before;
        taken->factors.pixels[i] = static_cast<uint16_t>(before);
        factors->factors.pixels[i] = static_cast<uint16_t>(added);
        part.shares.shares.pixels[i] = static_cast<float>(added / all);
    }
    part.factors = std::move(factors);
    if (continues) part.before = taken;
    return part;
}
}

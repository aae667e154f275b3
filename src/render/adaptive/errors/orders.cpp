#include "render/adaptive/errors/orders.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "integrate/terms.h"
#include "modes/mode.h"
#include "render/frame/samples.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace tyndall {
namespace {
constexpr int block_side = 8;
constexpr size_t max_tiles = 256, few_tiles = 64, layer_count = 2; // layers: color, inscatter
constexpr size_t first_passes = 4, few_passes = 16, max_passes = 64;
constexpr uint32_t use_orders = 0x0d3e5u;

// A tile of the image and its sampled pixels.
struct SweptTile {
    double weight = 0; // share of the pixels of all sampled tiles
    double share = 1;  // share of its pixels that are sampled
    size_t first = 0, count = 0;
};

// Result of one pass over the pixels, per pixel and layer: the mode's light minus path tracing's, and path tracing's
// mean over R, G and B.
struct SweepPass {
    std::vector<std::array<vec3, layer_count>> differences;
    std::vector<std::array<float, layer_count>> truths;
};

// All tiles of the image, or a stratified sample of them; every pass traces rays through the same pixels.
struct Sweep {
    std::vector<SweptTile> tiles;
    std::vector<ivec2> pixels;
    double share = 1; // sampled share of all tiles
    std::vector<SweepPass> passes{};
};

// One pixel of each 2×2 block of a tile, at the same place in each, clamped to `begin`..`end`.
SweptTile sweep_tile(ivec2 corner, ivec2 begin, ivec2 end, uint32_t place, std::vector<ivec2>& pixels) {
    const ivec2 offset(static_cast<int>(place & 1), static_cast<int>(place >> 1 & 1));
    const ivec2 low = glm::max(corner, begin), high = glm::min(corner + block_side, end);
    SweptTile tile{static_cast<double>((high - low).x * (high - low).y), 1, pixels.size(), 0};
    for (int y = corner.y; y < high.y; y += 2)
        for (int x = corner.x; x < high.x; x += 2)
            if (x + 1 >= low.x && y + 1 >= low.y) pixels.push_back(glm::clamp(ivec2(x, y) + offset, low, high - 1));
    tile.count = pixels.size() - tile.first, tile.share = static_cast<double>(tile.count) / tile.weight;
    return tile;
}

Sweep make_sweep(const View& view, size_t most) {
    const bool cropped = view.crop_low != view.crop_high;
    const ivec2 begin = cropped ? view.crop_low : ivec2(0), end = cropped ? view.crop_high : view.size;
    const ivec2 low = begin / block_side, size = (end - 1) / block_side + 1 - low;
    const size_t all = static_cast<size_t>(size.x) * static_cast<size_t>(size.y), count = std::min(all, most);
    Sweep sweep{{}, {}, static_cast<double>(count) / static_cast<double>(all)};
    double pixels = 0;
    for (size_t i = 0; i < count; ++i) {
        // One random tile from each of `count` strata.
        const uint32_t random = hash(view.seed, use_orders, static_cast<uint32_t>(i));
        const double at = static_cast<double>(i) + to_unit(random);
        const int tile = static_cast<int>(std::min(at / sweep.share * (1 - 1e-12), static_cast<double>(all - 1)));
        const ivec2 corner = (low + ivec2(tile % size.x, tile / size.x)) * block_side;
        sweep.tiles.push_back(sweep_tile(corner, begin, end, hash(random), sweep.pixels));
        pixels += sweep.tiles.back().weight;
    }
    for (SweptTile& tile : sweep.tiles) tile.weight /= pixels;
    return sweep;
}

// A mode with its settings and prepared data, ready to trace rays.
struct Traced {
    const Mode& mode;
    Snapshot snapshot;
    Settings settings;
    Prepared prepared;

    FrameTracer tracer(const View& view) const { return frame_tracer(mode, view, snapshot, settings, prepared); }
};

// The mode, and path tracing with as many scattering orders as the mode's grid; and for both, single scattering from
// lights alone. With the same random numbers that is part of the full result: subtracting it removes what both compute,
// and in thin fog nearly all the noise of their difference.
struct Compared {
    Traced mode, truth, mode_once, truth_once;
};

struct PixelLight {
    std::array<vec3, layer_count> values{};
    bool finite = true;
};

using TileLight = std::array<PixelLight, block_side * block_side / 4>;

TileLight light_of(const Traced& traced, const View& view, std::span<const ivec2> pixels) {
    PixelSample samples[std::tuple_size_v<TileLight>];
    trace_samples(traced.tracer(view), pixels, 0, {samples, pixels.size()}, {});
    TileLight light{};
    for (size_t k = 0; k < pixels.size(); ++k)
        light[k] = {{samples[k].color(), samples[k].inscatter}, samples[k].finite()};
    return light;
}

void add_pass(const Compared& compared, const View& given, const FrameOptions& options, Sweep& sweep) {
    View view = given;
    view.seed = hash(given.seed, use_orders, static_cast<uint32_t>(sweep.passes.size()));
    SweepPass pass;
    pass.differences.resize(sweep.pixels.size()), pass.truths.resize(sweep.pixels.size());
    parallel_for(static_cast<int64_t>(sweep.tiles.size()), [&](int64_t i) {
        if (options.cancel && *options.cancel) fail(ExitCode::internal, "render", "cancelled");
        const SweptTile& tile = sweep.tiles[static_cast<size_t>(i)];
        const std::span<const ivec2> pixels{sweep.pixels.data() + tile.first, tile.count};
        const TileLight own = light_of(compared.mode, view, pixels),
                        own_once = light_of(compared.mode_once, view, pixels);
        const TileLight all = light_of(compared.truth, view, pixels),
                        once = light_of(compared.truth_once, view, pixels);
        for (size_t k = 0; k < tile.count; ++k) {
            if (!own[k].finite || !own_once[k].finite || !all[k].finite || !once[k].finite) continue; // counts as black
            for (size_t layer = 0; layer < layer_count; ++layer) {
                pass.differences[tile.first + k][layer] =
                    (own[k].values[layer] - own_once[k].values[layer]) - (all[k].values[layer] - once[k].values[layer]);
                pass.truths[tile.first + k][layer] = channel_mean(all[k].values[layer]);
            }
        }
    });
    sweep.passes.push_back(std::move(pass));
}

// Sums over passes, for one layer, per pixel.
struct PixelSums {
    std::vector<dvec3> sums, squares; // of differences
    std::vector<double> truths;
    double passes = 0;

    explicit PixelSums(size_t pixels) : sums(pixels), squares(pixels), truths(pixels) {}
    void add(const SweepPass& pass, size_t layer, double sign) {
        for (size_t i = 0; i < sums.size(); ++i) {
            const dvec3 difference(pass.differences[i][layer]);
            sums[i] += sign * difference, squares[i] += sign * difference * difference;
            truths[i] += sign * double(pass.truths[i][layer]);
        }
        passes += sign;
    }
    // Product of a pixel's differences in two passes, averaged over all pairs of passes: its squared error, without
    // bias.
    double product(size_t i) const { return channel_mean(sums[i] * sums[i] - squares[i]) / (passes * (passes - 1)); }
};

// Mean over the image, and its variance due to the pixels that are not sampled.
struct ImageMean {
    double mean = 0, variance = 0;
};

// From a sample in two stages, of tiles and of pixels within them (Cochran 1977, 10.3); `value(i)`: of a pixel.
template<class Value> ImageMean image_mean(const Sweep& sweep, const Value& value) {
    std::vector<double> means; // per tile
    double mean = 0, within = 0, between = 0;
    for (const SweptTile& tile : sweep.tiles) {
        const double count = static_cast<double>(tile.count);
        double sum = 0, squares = 0;
        for (size_t i = tile.first; i < tile.first + tile.count; ++i) {
            const double one = value(i);
            sum += one, squares += one * one;
        }
        means.push_back(sum / count), mean += tile.weight * means.back();
        if (tile.count > 1)
            within += tile.weight * tile.weight * (1 - tile.share) * std::max(squares - sum * means.back(), 0.0) /
                      (count * (count - 1));
    }
    for (size_t t = 0; t < means.size(); ++t) between += std::pow(sweep.tiles[t].weight * (means[t] - mean), 2);
    return {mean, (1 - sweep.share) * between + sweep.share * within};
}

// Of the differences: their mean square relative to the ground truth's squared mean, and their mean relative to its
// mean. Variances: those due to the pixels that are not sampled.
struct Estimate {
    ImageMean squared, mean;
};

// Both are ratios of estimates from the same pixels: their variance is that of a linear combination of the two (Cochran
// 1977, 6.3).
Estimate estimate(const Sweep& sweep, const PixelSums& of) {
    const auto truth_at = [&](size_t i) { return of.truths[i] / of.passes; };
    const double truth = image_mean(sweep, truth_at).mean;
    const auto ratio = [&](int power, const auto& value) {
        const double mean = image_mean(sweep, value).mean, scale = std::pow(truth, -power);
        if (!(truth > 0)) return ImageMean{mean > 0 ? infinity : 0, 0};
        const auto linear = [&](size_t i) { return value(i) - power * mean / truth * truth_at(i); };
        return ImageMean{mean * scale, image_mean(sweep, linear).variance * scale * scale};
    };
    return {ratio(2, [&](size_t i) { return of.product(i); }),
            ratio(1, [&](size_t i) { return channel_mean(of.sums[i]) / of.passes; })};
}

// 97.5 % quantile of Student's (1908) t distribution with `freedom` degrees of freedom: two terms of the expansion of
// Fisher & Cornish (1960).
double student(double freedom) {
    constexpr double z = 1.959964;
    return z + (z * z * z + z) / (4 * freedom) +
           (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * freedom * freedom);
}

// The variance of a mean over passes, from how it changes when each of them in turn is left out.
double jackknife(std::span<const double> left_out) {
    const double count = static_cast<double>(left_out.size());
    double mean = 0, squares = 0;
    for (const double one : left_out) mean += one / count, squares += one * one;
    return (count - 1) / count * std::max(squares - count * mean * mean, 0.0);
}

// Bounds count the variance over passes (Tukey's jackknife) and that of the pixels that are not sampled.
OrdersError error_of(const Sweep& sweep, size_t layer) {
    PixelSums sums(sweep.pixels.size());
    for (const SweepPass& pass : sweep.passes) sums.add(pass, layer, 1);
    const auto [squared, mean] = estimate(sweep, sums);
    if (squared.mean == infinity) return {{0, infinity}, {infinity, infinity}};
    std::vector<double> squared_without, mean_without;
    for (const SweepPass& pass : sweep.passes) {
        sums.add(pass, layer, -1);
        const Estimate without = estimate(sweep, sums);
        squared_without.push_back(without.squared.mean), mean_without.push_back(without.mean.mean);
        sums.add(pass, layer, 1);
    }
    const double quantile = student(static_cast<double>(sweep.passes.size()) - 1), value = std::max(squared.mean, 0.0);
    const double bound = std::sqrt(value + quantile * std::sqrt(jackknife(squared_without) + squared.variance));
    const double mean_bound = std::abs(mean.mean) + quantile * std::sqrt(jackknife(mean_without) + mean.variance);
    return {{mean.mean, std::min(mean_bound, bound)}, {std::sqrt(value), bound}}; // no mean exceeds the RMS
}

OrdersError worse_of(const Sweep& sweep) {
    const OrdersError color = error_of(sweep, 0), fog = error_of(sweep, 1);
    return color.pixels.bound >= fog.pixels.bound ? color : fog;
}

Traced trace_by(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings) {
    return {mode, snapshot, settings, prepare_frame(mode, view, snapshot, settings, nullptr)};
}

Compared compare_with_path(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings) {
    Settings exact = settings;
    exact.path.orders = settings.fluence.orders;
    Settings once = settings;
    once.path.orders = once.fluence.orders = 1, once.terms.ambient = once.terms.emission = false;
    const Mode& truth = mode_of_all_orders();
    const Snapshot lamps = with_terms(snapshot, once.terms);
    return {trace_by(mode, view, snapshot, settings), trace_by(truth, view, snapshot, exact),
            trace_by(mode, view, lamps, once), trace_by(truth, view, lamps, once)};
}
}

bool takes_fluence(const Mode& mode, const Settings& settings) {
    return mode.adds_fluence && settings.fluence.orders > 1;
}

OrdersError orders_error(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings,
                         double error, const FrameOptions& options, const std::function<bool()>& stop) {
    const double enough = std::max(0.01, error / 3);
    const size_t last_passes = error > 0 ? max_passes : few_passes;
    View view = given;
    view.surface_parts = view.fog_parts = false, view.pixel_samples = view.batches = 1;
    view.lamp_samples = view.edge_samples = 1, view.allotted = nullptr, view.lamps.clear();
    const Compared compared = compare_with_path(mode, view, snapshot, settings);
    Sweep sweep = make_sweep(view, stop ? few_tiles : max_tiles);
    OrdersError result;
    for (size_t wanted = first_passes; wanted <= last_passes; wanted *= 2) {
        while (sweep.passes.size() < wanted) {
            if (wanted > first_passes && stop && stop()) return result;
            add_pass(compared, view, options, sweep);
        }
        result = worse_of(sweep);
        if (result.pixels.bound <= 1.5 * std::max(result.pixels.error, enough)) break;
    }
    return result;
}

std::optional<double> remaining_error(const Noise& other, double error) {
    constexpr double least = 0.3; // of the error: a smaller remainder takes more than ten times the samples
    const double left = error * error - other.bound * other.bound;
    if (left >= least * least * error * error) return std::sqrt(left);
    return {};
}

Limitation limitation_of(const OrdersError& orders) {
    constexpr double small = 0.02, wrong = 0.3;
    const double bound = orders.pixels.bound;
    const Severity severity = bound < small ? Severity::info : bound < wrong ? Severity::degraded : Severity::wrong;
    return {severity,
            &limitation::approximate_orders,
            Subject::setting,
            "fluence.orders",
            {100 * bound, 100 * orders.mean.bound}};
}
}

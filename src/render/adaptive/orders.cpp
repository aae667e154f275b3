#include "render/adaptive/orders.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "modes/mode.h"
#include "render/adaptive/tile_chances.h"
#include "render/frame/samples.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tyndall {
namespace {
constexpr int tile_side = 8;
constexpr size_t max_tiles = 256, few_tiles = 64, layer_count = 2; // layers: beauty, fog light
constexpr size_t first_passes = 4, few_passes = 16, max_passes = 64;
constexpr uint32_t use_orders = 0x0d3e5u;

double channel_mean(dvec3 value) { return (value.x + value.y + value.z) / 3; }

// Of a tile in one pass.
struct TileMeans {
    std::array<vec3, layer_count> difference{}, truth{}; // the mode's less path tracing's; path tracing's
};

// Tiles of the image, or as many as are looked at, spread evenly; and what each pass over them gave.
struct Sweep {
    std::vector<ivec2> corners;
    std::vector<double> weights; // how many pixels each has: fewer at the image's edges
    double share = 1;            // of all tiles
    std::vector<std::vector<TileMeans>> passes{};
};

Sweep make_sweep(const View& view, size_t most) {
    const bool cropped = view.crop_low != view.crop_high;
    const ivec2 begin = cropped ? view.crop_low : ivec2(0), end = cropped ? view.crop_high : view.size;
    const ivec2 low = begin / tile_side, size = (end - 1) / tile_side + 1 - low;
    const size_t all = static_cast<size_t>(size.x) * static_cast<size_t>(size.y), count = std::min(all, most);
    Sweep sweep{{}, {}, static_cast<double>(count) / static_cast<double>(all)};
    for (size_t i = 0; i < count; ++i) {
        // One at random of each of `count` runs of tiles.
        const double at = (static_cast<double>(i) + to_unit(hash(view.seed, use_orders, static_cast<uint32_t>(i))));
        const int tile = static_cast<int>(std::min(at / sweep.share * (1 - 1e-12), static_cast<double>(all - 1)));
        const ivec2 corner = (low + ivec2(tile % size.x, tile / size.x)) * tile_side;
        const ivec2 pixels = glm::min(corner + tile_side, end) - glm::max(corner, begin);
        sweep.corners.push_back(corner), sweep.weights.push_back(pixels.x * pixels.y);
    }
    return sweep;
}

// One pixel of each 2×2 of a tile that begins in the image: the same place in all of them, as far as they lie in the
// image, another in each pass.
size_t pixels_of(ivec2 corner, ivec2 size, uint32_t seed, std::span<ivec2> pixels) {
    const uint32_t place = hash(static_cast<uint32_t>(corner.x), static_cast<uint32_t>(corner.y), seed);
    const ivec2 offset(static_cast<int>(place & 1), static_cast<int>(place >> 1 & 1));
    size_t count = 0;
    for (int y = 0; y < tile_side; y += 2)
        for (int x = 0; x < tile_side; x += 2) {
            const ivec2 low = corner + ivec2(x, y);
            if (low.x < size.x && low.y < size.y) pixels[count++] = glm::min(low + offset, size - 1);
        }
    return count;
}

// A mode and path tracing, of as many orders as the mode's grid.
struct Compared {
    const Mode& mode;
    const Mode& truth;
    Settings settings, truth_settings;
    Prepared prepared, truth_prepared;
};

FrameTracer tracer_of(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                      const Prepared& prepared) {
    return {view, snapshot, prepared.scatter, mode.surfaces, settings.terms.light_points, prepared.light_depths};
}

void add_pass(const Compared& compared, const View& given, const Snapshot& snapshot, const FrameOptions& options,
              Sweep& sweep) {
    View view = given;
    view.seed = hash(given.seed, use_orders, static_cast<uint32_t>(sweep.passes.size()));
    const FrameTracer own = tracer_of(compared.mode, view, snapshot, compared.settings, compared.prepared);
    const FrameTracer truth =
        tracer_of(compared.truth, view, snapshot, compared.truth_settings, compared.truth_prepared);
    std::vector<TileMeans> means(sweep.corners.size());
    parallel_for(static_cast<int64_t>(means.size()), [&](int64_t i) {
        if (options.cancel && *options.cancel) fail(ExitCode::internal, "render", "cancelled");
        ivec2 pixels[16];
        const size_t count = pixels_of(sweep.corners[static_cast<size_t>(i)], view.size, view.seed, pixels);
        PixelSample own_samples[16], truth_samples[16];
        trace_samples(own, {pixels, count}, 0, {own_samples, count}, {});
        trace_samples(truth, {pixels, count}, 0, {truth_samples, count}, {});
        TileMeans& mean = means[static_cast<size_t>(i)];
        float finite = 0;
        for (size_t k = 0; k < count; ++k) {
            const PixelSample &a = own_samples[k], &b = truth_samples[k];
            if (!a.finite() || !b.finite()) continue;
            mean.difference[0] += a.color() - b.color(), mean.difference[1] += a.inscatter - b.inscatter;
            mean.truth[0] += b.color(), mean.truth[1] += b.inscatter, ++finite;
        }
        for (size_t layer = 0; finite > 0 && layer < layer_count; ++layer)
            mean.difference[layer] /= finite, mean.truth[layer] /= finite;
    });
    sweep.passes.push_back(std::move(means));
}

// Of a layer, from all passes but one.
struct Estimate {
    double squared = 0, mean = 0; // of differences, as shares of the truth's mean squared, and of its mean
    double tile_variance = 0;     // of the former between tiles
};

// Products of differences in two passes have the square of the tile's difference for their mean: the average over all
// pairs of passes, by their sum.
Estimate estimate(const Sweep& sweep, size_t layer, size_t left_out) {
    double passes = 0, truth = 0;
    for (size_t p = 0; p < sweep.passes.size(); ++p) passes += p != left_out;
    const double pixels = std::accumulate(sweep.weights.begin(), sweep.weights.end(), 0.0);
    double squares = 0, sums = 0;
    std::vector<double> products;
    for (size_t t = 0; t < sweep.corners.size(); ++t) {
        const double share = sweep.weights[t] / pixels;
        dvec3 sum(0), own(0);
        for (size_t p = 0; p < sweep.passes.size(); ++p) {
            if (p == left_out) continue;
            const dvec3 difference(sweep.passes[p][t].difference[layer]);
            sum += difference, own += difference * difference;
            truth += share * channel_mean(dvec3(sweep.passes[p][t].truth[layer])) / passes;
        }
        products.push_back(channel_mean(sum * sum - own) / (passes * (passes - 1)));
        squares += share * products.back(), sums += share * channel_mean(sum) / passes;
    }
    if (!(truth > 0)) return {squares > 0 ? infinity : 0, 0, 0};
    double variance = 0;
    for (size_t t = 0; t < products.size(); ++t)
        variance += std::pow(sweep.weights[t] / pixels * (products[t] - squares), 2);
    const double scale = 1 / (truth * truth);
    return {squares * scale, sums / truth, variance * scale * scale};
}

// Of Student's (1908) distribution with so many degrees of freedom, below which 97.5 % lie; as of Fisher & Cornish
// (1960), two terms.
double student(double freedom) {
    constexpr double z = 1.959964;
    return z + (z * z * z + z) / (4 * freedom) +
           (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * freedom * freedom);
}

// The bound by what the estimate changes with each pass, were it left out (Tukey's jackknife).
OrdersError error_of(const Sweep& sweep, size_t layer) {
    const size_t passes = sweep.passes.size();
    const Estimate all = estimate(sweep, layer, passes);
    if (all.squared == infinity) return {0, {infinity, infinity}};
    double mean = 0, squares = 0;
    for (size_t p = 0; p < passes; ++p) {
        const double one = estimate(sweep, layer, p).squared;
        mean += one / static_cast<double>(passes), squares += one * one;
    }
    const double count = static_cast<double>(passes);
    const double by_passes = (count - 1) / count * std::max(squares - count * mean * mean, 0.0);
    const double variance = by_passes + (1 - sweep.share) * all.tile_variance, value = std::max(all.squared, 0.0);
    return {all.mean, {std::sqrt(value), std::sqrt(value + student(count - 1) * std::sqrt(variance))}};
}

OrdersError worse_of(const Sweep& sweep) {
    const OrdersError color = error_of(sweep, 0), fog = error_of(sweep, 1);
    return color.tiles.bound >= fog.tiles.bound ? color : fog;
}

Compared compare_with_path(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings) {
    Settings exact = settings;
    exact.path.orders = settings.fluence.orders;
    const Mode& truth = mode_of_all_orders();
    return {mode,
            truth,
            settings,
            exact,
            prepare_frame(mode, view, snapshot, settings, nullptr),
            prepare_frame(truth, view, snapshot, exact, nullptr)};
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
            add_pass(compared, view, snapshot, options, sweep);
        }
        result = worse_of(sweep);
        if (result.tiles.bound <= 1.5 * std::max(result.tiles.error, enough)) break;
    }
    return result;
}

std::optional<double> error_beside(const OrdersError& orders, double error) {
    constexpr double least = 0.3; // of the error: less takes more than ten times as many samples
    const double left = error * error - orders.tiles.bound * orders.tiles.bound;
    if (left >= least * least * error * error) return std::sqrt(left);
    return {};
}

Limitation limitation_of(const OrdersError& orders) {
    constexpr double small = 0.02, wrong = 0.3;
    const double bound = orders.tiles.bound;
    const Severity severity = bound < small ? Severity::info : bound < wrong ? Severity::degraded : Severity::wrong;
    return {severity,
            &limitation::approximate_orders,
            Subject::setting,
            "fluence.orders",
            {100 * bound, 100 * orders.mean}};
}
}

#include "render/adaptive/pilot.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "modes/mode.h"
#include "render/frame/samples.h"
#include "trace/sampling/lamp_samples.h"
#include "trace/transmittance/light_depth.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tyndall {
namespace {
constexpr double confidence = 1.96; // standard deviations below which 97.5 % of a normal lie

double channel_mean(dvec3 value) { return (value.x + value.y + value.z) / 3; }
}

Sums sums_of(std::span<const vec3> truth, std::span<const vec3> own, std::span<const vec3> center, size_t layer) {
    Sums sums;
    for (size_t i = 0; i < 16; ++i) {
        const size_t a = 2 * i + layer, b = a + pilot_values / 2;
        if (!is_finite(truth[a] + truth[b] + own[a] + own[b] + center[a])) continue;
        const dvec3 ta(truth[a]), tb(truth[b]), oa(own[a]), ob(own[b]), c(center[a]);
        const double products[] = {channel_mean((oa - ta) * (ob - tb)), 0.5 * channel_mean((oa - ob) * (oa - ob)),
                                   channel_mean((c - ta) * (c - tb))};
        for (int k = 0; k < product_count; ++k)
            sums.products[k] += products[k], sums.squares[k] += products[k] * products[k];
        sums.mean += 0.5 * channel_mean(ta + tb), sums.count += 1;
    }
    return sums;
}

SquaredError squared_error(const TileSums& sums_of_tiles, Product product) {
    const auto& [tiles, lamp_tiles, all] = sums_of_tiles;
    Sums lamps, others;
    for (size_t i = 0; i < tiles.size(); ++i) (i < lamp_tiles ? lamps : others).add(tiles[i], 1);
    if (product == of_sample) lamps.products[product] = lamps.squares[product] = 0;
    const double count = static_cast<double>(tiles.size() - lamp_tiles);
    const double stands_for = count > 0 ? (all - static_cast<double>(lamp_tiles)) / count : 0;
    const auto together = [&](const Sums& some, double share) {
        Sums sums = lamps;
        sums.add(some, share);
        return sums;
    };
    const Sums sums = together(others, stands_for);
    SquaredError result{std::max(sums.square(product), 0.0), 0};
    double mean = 0, squares = 0, seen = 0;
    for (size_t i = lamp_tiles; i < tiles.size() && count > 1; ++i) {
        Sums rest = others;
        rest.add(tiles[i], -1);
        const double value = together(rest, stands_for * count / (count - 1)).square(product), off = value - mean;
        mean += off / ++seen, squares += off * (value - mean);
    }
    double variance = std::max(squares * (count - 1) / std::max(count, 1.0), 0.0);
    if (lamps.squares[product] > 0)
        variance += lamps.squares[product] * std::pow(sums.count / (sums.mean * sums.mean), 2);
    result.bound = result.value + confidence * std::sqrt(variance);
    if (!(result.bound >= 0)) result.bound = infinity;
    return result;
}

namespace {
constexpr int tile_side = 4;
constexpr uint32_t use_pilot = 0x9170u;
constexpr float quiet_nan = std::numeric_limits<float>::quiet_NaN();

// Sets tiles that show a pixel of the picture, all or some: those with a lamp, and the others in an order of which any
// beginning is spread evenly.
void spread_tiles(const View& view, Pilot& pilot) {
    const bool cropped = view.crop_low != view.crop_high;
    const ivec2 first = (cropped ? view.crop_low : ivec2(0)) / tile_side;
    const ivec2 tiles = ((cropped ? view.crop_high : view.size) - 1) / tile_side + 1 - first;
    pilot.tiles = static_cast<double>(tiles.x) * tiles.y;
    size_t wanted = max_lamp_tiles;
    std::vector<ivec2>& corners = pilot.corners;
    const auto add = [&](ivec2 tile) {
        const ivec2 corner = (first + tile) * tile_side;
        if (corners.size() < wanted && !std::ranges::count(corners, corner)) corners.push_back(corner);
    };
    for (const View::Lamp& lamp : view.lamps) {
        const vec2 place = glm::floor(lamp.at / static_cast<float>(tile_side)) - vec2(first);
        if (place.x >= 0 && place.y >= 0 && place.x < static_cast<float>(tiles.x) &&
            place.y < static_cast<float>(tiles.y))
            add(ivec2(place));
    }
    pilot.lamp_tiles = corners.size();
    wanted = static_cast<size_t>(std::min<double>(pilot.tiles, max_pilot_tiles));
    for (uint32_t k = 0; k < 4 * max_pilot_tiles; ++k) {
        const Sample2 place = sample2(k, use_pilot);
        add(glm::min(ivec2(vec2(place.x, place.y) * vec2(tiles)), tiles - 1));
    }
    // Few tiles are taken all, though chance has left some out.
    for (int y = 0; y < tiles.y && corners.size() < wanted; ++y)
        for (int x = 0; x < tiles.x && corners.size() < wanted; ++x) add({x, y});
    if (pilot.lamp_tiles == corners.size()) pilot.lamp_tiles = 0; // there are no others
}

FrameTracer tracer_of(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                      const Prepared& prepared) {
    return {view, snapshot, prepared.scatter, mode.surfaces, settings.terms.light_points, prepared.light_depths};
}

// Colour and fog light of a tile's pixels, means of the first and of the second half of the samples; NaN where there is
// no pixel or a sample is not finite.
void follow_tile(const FrameTracer& tracer, ivec2 corner, std::span<vec3> result) {
    const ivec2 end = glm::min(corner + tile_side, tracer.view.size);
    std::ranges::fill(result, vec3(quiet_nan));
    ivec2 pixels[16];
    size_t count = 0;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) pixels[count++] = {x, y};
    PixelSample samples[16];
    const int all = tracer.view.pixel_samples, half = std::max(all / 2, 1);
    for (int s = 0; s < all; ++s) {
        trace_samples(tracer, {pixels, count}, s, {samples, count}, {});
        for (size_t i = 0; i < count; ++i) {
            vec3* mean = &result[2 * (16 * static_cast<size_t>(s / half) + i)];
            const bool fresh = s % half == 0;
            const float share = 1 / static_cast<float>(half), kept = samples[i].finite() ? share : quiet_nan;
            mean[0] = (fresh ? vec3(0) : mean[0]) + kept * samples[i].color;
            mean[1] = (fresh ? vec3(0) : mean[1]) + kept * samples[i].inscatter;
        }
    }
}

// Tiles `begin` to `end` of the pilot.
void follow(const FrameTracer& tracer, const Pilot& pilot, size_t begin, size_t end, const FrameOptions& options,
            std::vector<vec3>& result) {
    result.resize(end * pilot_values);
    parallel_for(static_cast<int64_t>(end - begin), [&](int64_t i) {
        if (options.cancel && *options.cancel) fail(ExitCode::internal, "render", "cancelled");
        const size_t tile = begin + static_cast<size_t>(i);
        follow_tile(tracer, pilot.corners[tile], {result.data() + tile * pilot_values, pilot_values});
    });
}

// Modes that shade surfaces themselves spread their samples by the filter alone.
View view_for(const Mode& mode, const Pilot& pilot) {
    View view = pilot.view;
    if (mode.surfaces != Surfaces::shared) view.lamps.clear();
    return view;
}

SquaredError worse(SquaredError a, SquaredError b) { return {std::max(a.value, b.value), std::max(a.bound, b.bound)}; }
}

double tiles_stood_for(const Pilot& pilot, size_t tile) {
    const double lamps = static_cast<double>(pilot.lamp_tiles);
    return tile < pilot.lamp_tiles ? 1 : (pilot.tiles - lamps) / (static_cast<double>(pilot.corners.size()) - lamps);
}

Pilot make_pilot(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings* truth,
                 const FrameOptions& options, const std::function<bool()>& enough) {
    Pilot pilot;
    pilot.view = view;
    pilot.view.per_light = false, pilot.view.pixel_samples = pilot.view.batches = 2;
    pilot.view.lamp_samples = pilot.view.edge_samples = 1;
    pilot.view.lamps = lamps_in(view, snapshot);
    spread_tiles(pilot.view, pilot);
    if (!truth) return pilot;

    const Prepared prepared = prepare_frame(mode, pilot.view, snapshot, *truth, nullptr);
    const FrameTracer tracer = tracer_of(mode, pilot.view, snapshot, *truth, prepared);
    size_t done = 0;
    const double start = steady_seconds();
    while (done < pilot.corners.size() && (done < fewest_pilot_tiles || !enough())) {
        const size_t end = std::min(done + fewest_pilot_tiles, pilot.corners.size());
        follow(tracer, pilot, done, end, options, pilot.truth);
        done = end;
    }
    pilot.truth_seconds = (steady_seconds() - start) / 2 * (pilot.tiles / static_cast<double>(done));
    pilot.corners.resize(done);
    return pilot;
}

Measured measure(const Pilot& pilot, const Mode& mode, const Snapshot& snapshot, const Settings& settings,
                 const FrameOptions& options, const Seconds& clock) {
    Measured result;
    const View view = view_for(mode, pilot);
    const double start = clock();
    result.prepared = std::make_shared<const Prepared>(prepare_frame(mode, view, snapshot, settings, nullptr));
    const double prepared = clock();
    std::vector<vec3> own, center;
    const size_t count = pilot.corners.size();
    follow(tracer_of(mode, view, snapshot, settings, *result.prepared), pilot, 0, count, options, own);
    const double followed = clock();
    View single = view;
    single.pixel_samples = single.batches = 1, single.seed = hash(single.seed, use_pilot);
    follow(tracer_of(mode, single, snapshot, settings, *result.prepared), pilot, 0, count, options, center);

    // The quicker of two looks: so few rays are easily held up.
    result.prepare_seconds = prepared - start;
    const double sample = std::min((followed - prepared) / 2, clock() - followed);
    result.sample_seconds = sample * (pilot.tiles / static_cast<double>(count));
    const std::vector<vec3>& truth = pilot.truth.empty() ? own : pilot.truth;
    for (size_t layer = 0; layer < 2; ++layer) {
        TileSums sums{{}, pilot.lamp_tiles, pilot.tiles};
        for (size_t tile = 0; tile < count; ++tile) {
            const auto of = [&](const std::vector<vec3>& all) {
                return std::span(all.data() + tile * pilot_values, pilot_values);
            };
            sums.tiles.push_back(sums_of(of(truth), of(own), of(center), layer));
        }
        result.integrator = worse(result.integrator, squared_error(sums, of_integrator));
        result.sample = worse(result.sample, squared_error(sums, of_sample));
        result.single = worse(result.single, squared_error(sums, of_single));
    }
    return result;
}

double spread_power(const Pilot& pilot, const Mode& mode, const Snapshot& snapshot, const Settings& settings,
                    const Prepared& prepared, double sample_variance, const FrameOptions& options) {
    constexpr int samples = 8;
    View view = view_for(mode, pilot);
    view.pixel_samples = 2 * samples;
    std::vector<vec3> own;
    const size_t count = pilot.corners.size();
    follow(tracer_of(mode, view, snapshot, settings, prepared), pilot, 0, count, options, own);
    double variance = 0;
    for (size_t layer = 0; layer < 2; ++layer) {
        Sums sums;
        for (size_t tile = pilot.lamp_tiles; tile < count; ++tile) {
            const std::span<const vec3> means(own.data() + tile * pilot_values, pilot_values);
            sums.add(sums_of(means, means, means, layer), 1);
        }
        variance = std::max(variance, sums.square(of_sample));
    }
    if (!(variance > 0) || !(sample_variance > variance)) return 1;
    return std::clamp(std::log(sample_variance / variance) / std::log(double{samples}), 1.0, 2.0);
}
}

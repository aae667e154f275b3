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
constexpr double confidence = 1.96; // 97.5 % quantile of the normal distribution
}

Sums sums_of(std::span<const vec3> truth, std::span<const vec3> own, size_t layer) {
    Sums sums;
    for (size_t i = 0; i < 16; ++i) {
        const size_t a = 2 * i + layer, b = a + pilot_values / 2;
        if (!is_finite(truth[a] + truth[b] + own[a] + own[b])) continue;
        const dvec3 ta(truth[a]), tb(truth[b]), oa(own[a]), ob(own[b]);
        const double products[] = {channel_mean((oa - ta) * (ob - tb)), 0.5 * channel_mean((oa - ob) * (oa - ob))};
        for (int k = 0; k < product_count; ++k)
            sums.products[k] += products[k], sums.squares[k] += products[k] * products[k];
        sums.mean += 0.5 * channel_mean(ta + tb), sums.count += 1;
    }
    return sums;
}

SquaredError squared_error(std::span<const Sums> sums, std::span<const DrawnTile> tiles, Product product) {
    double products = 0, mean = 0, count = 0, largest = 0;
    for (size_t i = 0; i < sums.size(); ++i) {
        const double weight = tiles[i].weight;
        products += weight * sums[i].products[product], mean += weight * sums[i].mean, count += weight * sums[i].count;
        largest = std::max(largest, sums[i].squares[product]);
    }
    if (largest == 0) return {};
    if (!(mean > 0)) return {infinity, infinity};

    // Influence of each tile on the ratio, to first order.
    const double per_product = count / (mean * mean), value = products * per_product;
    double variance = 0, third = 0, noise = 0;
    for (size_t i = 0; i < sums.size(); ++i) {
        const double weight = tiles[i].weight, chance = tiles[i].chance;
        const double change = weight * (per_product * sums[i].products[product] - 2 * value * sums[i].mean / mean +
                                        value * sums[i].count / count);
        variance += (1 - chance) * change * change, third += (1 - chance) * change * change * change;
        // A pixel's squared product stands for its variance.
        const double of_pixels = weight * weight * per_product * per_product * sums[i].squares[product];
        variance += chance * of_pixels, noise += of_pixels;
    }
    const double lump = variance > 0 ? std::max(third / variance, 0.0) : 0, half = confidence * lump / 2;
    const double bound = std::max(value, 0.0) + confidence * (half + std::sqrt(variance + half * half));
    return {std::max(value, 0.0), bound >= 0 ? bound : infinity, noise > 0.5 * variance};
}

namespace {
constexpr size_t tiles_between_stops = 8;
constexpr uint32_t use_pilot = 0x9170u;
constexpr float quiet_nan = std::numeric_limits<float>::quiet_NaN();

// The pixels of a tile to trace: all, or one of each 2×2 block.
size_t pixels_of(const Pilot& pilot, const DrawnTile& tile, std::span<ivec2> pixels, std::span<size_t> places) {
    const uint32_t shift = hash(static_cast<uint32_t>(tile.corner.x), static_cast<uint32_t>(tile.corner.y), pilot.seed);
    size_t count = 0;
    for (size_t i = 0; i < 16; ++i) {
        const int x = static_cast<int>(i % 4), y = static_cast<int>(i / 4);
        const ivec2 p = tile.corner + ivec2(x, y);
        if (p.x >= pilot.view.size.x || p.y >= pilot.view.size.y) continue;
        const bool chosen = x % 2 == static_cast<int>(shift & 1) && y % 2 == static_cast<int>(shift >> 1 & 1);
        if (tile.chance >= 1 || chosen) pixels[count] = p, places[count++] = i;
    }
    return count;
}

// Color and inscatter of a tile's pixels: means of the first and of the second half of the samples; NaN where a pixel
// is not traced or a sample is not finite. Returns the work.
double follow_tile(const FrameTracer& tracer, std::span<const ivec2> pixels, std::span<const size_t> places,
                   std::span<vec3> result) {
    std::ranges::fill(result, vec3(quiet_nan));
    if (pixels.empty()) return 0;
    double work = 0;
    PixelSample samples[16];
    const int all = tracer.view.pixel_samples, half = std::max(all / 2, 1);
    for (int s = 0; s < all; ++s) {
        trace_samples(tracer, pixels, s, {samples, pixels.size()}, {});
        for (size_t i = 0; i < pixels.size(); ++i) {
            vec3* mean = &result[2 * (16 * static_cast<size_t>(s / half) + places[i])];
            const bool fresh = s % half == 0;
            const float share = 1 / static_cast<float>(half), kept = samples[i].finite() ? share : quiet_nan;
            mean[0] = (fresh ? vec3(0) : mean[0]) + kept * samples[i].color();
            mean[1] = (fresh ? vec3(0) : mean[1]) + kept * samples[i].inscatter;
            work += ray_work + samples[i].steps;
        }
    }
    return work;
}

// One pass over tiles `begin` to `end`, with its own random numbers, averaged into the results of earlier passes.
Cost follow(FrameTracer tracer, const Pilot& pilot, int pass, size_t begin, size_t end, std::vector<vec3>& result) {
    const double start = steady_seconds();
    std::atomic<int64_t> work = 0; // integers: their sum does not depend on the order
    View view = tracer.view;
    if (pass > 0) view.seed = hash(view.seed, static_cast<uint32_t>(pass));
    const FrameTracer own = tracer.with(view);
    result.resize(std::max(result.size(), end * pilot_values));
    parallel_for(static_cast<int64_t>(end - begin), [&](int64_t i) {
        if (pilot.cancel && *pilot.cancel) fail(ExitCode::internal, "render", "cancelled");
        const size_t tile = begin + static_cast<size_t>(i);
        ivec2 pixels[16];
        size_t places[16];
        const size_t count = pixels_of(pilot, pilot.tiles[tile], pixels, places);
        std::array<vec3, pilot_values> values;
        work += static_cast<int64_t>(follow_tile(own, {pixels, count}, {places, count}, values));
        vec3* mean = result.data() + tile * pilot_values;
        for (size_t k = 0; k < pilot_values; ++k)
            mean[k] = pass ? mean[k] + (values[k] - mean[k]) / static_cast<float>(pass + 1) : values[k];
    });
    return {steady_seconds() - start, static_cast<double>(work)};
}

// Keeps the first tiles, which are in random order, and lets them stand for all.
void keep_first(size_t count, Pilot& pilot) {
    const double share = static_cast<double>(count) / static_cast<double>(pilot.tiles.size());
    pilot.tiles.resize(count);
    for (DrawnTile& tile : pilot.tiles) tile.weight /= share, tile.chance *= share;
}

// One pass over the first tiles: as many as time and work allow.
void follow_first(const FrameTracer& tracer, Pilot& pilot) {
    size_t done = 0;
    while (done < pilot.tiles.size()) {
        size_t end = done + tiles_between_stops;
        if (done > 0 && !pilot.stop)
            end = static_cast<size_t>(static_cast<double>(done) * std::min(pilot.enough_work / pilot.cost.work, 1e6));
        end = std::clamp(end, done + 1, pilot.tiles.size());
        pilot.cost += follow(tracer, pilot, 0, done, end, pilot.truth);
        done = end;
        if ((pilot.stop && pilot.stop()) || pilot.cost.work > 0.9 * pilot.enough_work) break;
    }
    if (done < pilot.tiles.size()) keep_first(done, pilot);
}

// Traces the passes that are missing: the first `seen` tiles have had `passes` of them, the others none.
Cost follow_rest(const FrameTracer& tracer, const Pilot& pilot, size_t seen, int passes, std::vector<vec3>& result) {
    Cost cost;
    for (int pass = passes; pass < pilot.passes && seen > 0; ++pass)
        cost += follow(tracer, pilot, pass, 0, seen, result);
    for (int pass = 0; pass < pilot.passes && seen < pilot.tiles.size(); ++pass)
        cost += follow(tracer, pilot, pass, seen, pilot.tiles.size(), result);
    return cost;
}

std::span<const vec3> values_of(const std::vector<vec3>& all, size_t tile) {
    return {all.data() + tile * pilot_values, pilot_values};
}

// Modes that shade surfaces themselves place their samples by the filter alone.
View view_for(const Mode& mode, const Pilot& pilot) {
    View view = pilot.view;
    if (mode.surfaces != Surfaces::shared) view.lamps.clear();
    return view;
}

std::shared_ptr<const Prepared> prepare(const Pilot& pilot, const Mode& mode, const Snapshot& snapshot,
                                        const Settings& settings) {
    View view = view_for(mode, pilot);
    view.seed = pilot.seed;
    return std::make_shared<const Prepared>(prepare_frame(mode, view, snapshot, settings, nullptr));
}

SquaredError worse(SquaredError a, SquaredError b) {
    return {std::max(a.value, b.value), std::max(a.bound, b.bound), a.bound > b.bound ? a.by_noise : b.by_noise};
}
}

SquaredError error_of(const Pilot& pilot, const std::vector<vec3>& truth, const std::vector<vec3>& own,
                      Product product) {
    SquaredError result;
    const size_t count = own.size() / pilot_values;
    for (size_t layer = 0; layer < 2; ++layer) {
        std::vector<Sums> sums;
        for (size_t tile = 0; tile < count; ++tile) {
            sums.push_back(sums_of(values_of(truth, tile), values_of(own, tile), layer));
            if (pilot.tiles[tile].chance < 1) sums.back().scale(4); // one pixel stands for four
        }
        result = worse(result, squared_error(sums, {pilot.tiles.data(), count}, product));
    }
    return result;
}

Pilot make_pilot(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings* truth,
                 TileChances chances, uint32_t salt, const FrameOptions& options,
                 std::shared_ptr<const Prepared> prepared, std::function<bool()> stop, double enough_work) {
    Pilot pilot{&mode, &snapshot, options.cancel};
    if (truth) pilot.truth_settings = *truth;
    pilot.view = view, pilot.seed = view.seed, pilot.chances = std::move(chances);
    pilot.view.surface_parts = pilot.view.fog_parts = false, pilot.view.pixel_samples = pilot.view.batches = 2;
    pilot.view.lamp_samples = pilot.view.edge_samples = 1, pilot.view.allotted = nullptr;
    pilot.view.seed = hash(view.seed, use_pilot, salt);
    pilot.view.lamps = lamps_in(view, snapshot);
    pilot.stop = std::move(stop), pilot.enough_work = enough_work;
    if (truth) pilot.prepared = prepared ? std::move(prepared) : prepare(pilot, mode, snapshot, *truth);
    grow(pilot);
    return pilot;
}

double Pilot::samples() const {
    double count = 0;
    for (const DrawnTile& tile : tiles) count += tile.chance < 1 ? 4 : 16;
    return 2 * count * passes;
}

double Pilot::pixels() const { return 16 * all(); }

void grow(Pilot& pilot, bool by_noise) {
    const size_t seen = pilot.tiles.size();
    const int passes = pilot.passes;
    if (by_noise) {
        pilot.passes *= 2;
    } else {
        const double before = pilot.drawings++, now = pilot.drawings;
        for (DrawnTile& tile : pilot.tiles) tile.weight *= before / now;
        const uint32_t seed = hash(pilot.view.seed, static_cast<uint32_t>(pilot.drawings));
        std::vector<DrawnTile> drawn = draw_tiles(pilot.chances, drawing_tiles, seed);
        std::ranges::sort(drawn, {}, [&](const DrawnTile& tile) {
            return hash(static_cast<uint32_t>(tile.corner.x), static_cast<uint32_t>(tile.corner.y), seed);
        });
        for (DrawnTile tile : drawn) {
            const auto same = std::ranges::find(pilot.tiles, tile.corner, &DrawnTile::corner);
            tile.weight /= now;
            if (same == pilot.tiles.end())
                pilot.tiles.push_back(tile);
            else
                same->weight += tile.weight;
        }
    }
    if (!pilot.truth_settings) return;
    const FrameTracer tracer =
        frame_tracer(*pilot.mode, pilot.view, *pilot.snapshot, *pilot.truth_settings, *pilot.prepared);
    if (seen == 0)
        follow_first(tracer, pilot);
    else
        pilot.cost += follow_rest(tracer, pilot, seen, passes, pilot.truth);
}

Measurement measure(const Pilot& pilot, PilotRun& run, const Seconds& clock) {
    const double start = clock();
    if (!run.prepared) {
        run.prepared = prepare(pilot, run.mode, run.of(pilot), run.settings);
        run.prepare_seconds = clock() - start;
    }
    const double prepared = clock();
    const View view = view_for(run.mode, pilot);
    const Cost cost = follow_rest(frame_tracer(run.mode, view, run.of(pilot), run.settings, *run.prepared), pilot,
                                  run.values.size() / pilot_values, run.passes, run.values);
    run.passes = pilot.passes, run.cost += Cost{clock() - prepared, cost.work};
    const std::vector<vec3>& truth = pilot.truth.empty() ? run.values : pilot.truth;
    Measurement result;
    result.integrator = error_of(pilot, truth, run.values, of_integrator);
    result.sample = error_of(pilot, truth, run.values, of_sample);
    result.sample.value *= pilot.passes, result.sample.bound *= pilot.passes; // they are those of means over the passes
    result.prepare_seconds = run.prepare_seconds, result.prepared = run.prepared;
    const double scale = pilot.pixels() / pilot.samples();
    result.sample_seconds = scale * run.cost.seconds, result.sample_work = scale * run.cost.work;
    return result;
}

Measurement measure(const Pilot& pilot, const Mode& mode, const Settings& settings, const Seconds& clock) {
    PilotRun run{mode, settings};
    return measure(pilot, run, clock);
}

double variance_power(const Pilot& pilot, const Mode& mode, const Settings& settings, const Prepared& prepared) {
    constexpr int samples = 8;
    View view = view_for(mode, pilot);
    const auto variance_of_means = [&](int of) {
        view.pixel_samples = 2 * of;
        std::vector<vec3> own;
        follow(frame_tracer(mode, view, *pilot.snapshot, settings, prepared), pilot, 0, 0, pilot.tiles.size(), own);
        return error_of(pilot, own, own, of_sample).value;
    };
    const double one = variance_of_means(1), many = variance_of_means(samples);
    if (!(many > 0) || !(one > many)) return 1;
    return std::clamp(std::log(one / many) / std::log(double{samples}), 1.0, 2.0);
}
}

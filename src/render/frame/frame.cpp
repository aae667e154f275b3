// The pixel loop: blocks of pixels in parallel, each pixel owned by one task and filtered in sample order.
#include "render/frame/frame.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/cache_folder.h"
#include "base/parallel.h"
#include "modes/mode.h"
#include "render/frame/camera_paths.h"
#include "render/frame/edges.h"
#include "render/frame/frame_task.h"
#include "render/frame/part.h"
#include "render/frame/pixel_sum.h"
#include "trace/mattes.h"
#include "trace/sampling/lamp_samples.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
void render_tile(const FrameTask& task, const PixelTile& tile, Layers& layers, FrameStats& stats) {
    const View& view = task.tracer.view;
    const size_t part_count = task.parts.size(), of_fog = task.fog_parts, count = tile.count;
    const int sample_count = samples_of(view, tile.corner), batch_size = sample_count / batches_of(view, tile.corner);
    if (sample_count == 0) return; // the allotment adds no samples to this tile
    PixelSum sums[16];
    PixelSample samples[16];
    int64_t steps[16] = {};
    std::vector<vec3> fog_parts(of_fog * count), part_sums(part_count * count, vec3(0));
    for (int s = 0; s < sample_count; ++s) {
        trace_samples(task.tracer, {tile.pixels, count}, s, {samples, count}, fog_parts);
        for (size_t i = 0; i < count; ++i) {
            if (!contains(layers, tile.pixels[i])) continue;
            ++stats.camera_rays, steps[i] += samples[i].steps;
            const std::span<const vec3> parts{fog_parts.data() + i * of_fog, of_fog};
            if (!samples[i].finite() || !std::ranges::all_of(parts, is_finite)) {
                stats.drop(tile.pixels[i]);
                continue;
            }
            sums[i].add(samples[i]);
            for (size_t k = 0; k < of_fog; ++k) part_sums[i * part_count + k] += parts[k];
            if (of_fog < part_count) part_sums[i * part_count + of_fog] += samples[i].weight * samples[i].channels;
        }
        if ((s + 1) % batch_size) continue;
        for (size_t i = 0; i < count; ++i) sums[i].end_batch(batch_size);
    }

    if (has_center_depths(task.tracer)) {
        float depths[16];
        center_depths(task.tracer, {tile.pixels, count}, depths);
        for (size_t i = 0; i < count; ++i) sums[i].depth = depths[i];
    }

    const float samples_float = static_cast<float>(sample_count);
    for (size_t i = 0; i < count; ++i) {
        if (!contains(layers, tile.pixels[i])) continue;
        const ivec2 p = tile.pixels[i] - layers.low;
        store_pixel(sums[i], sample_count, p, layers);
        stats.steps += static_cast<uint64_t>(steps[i]);
        if (!layers.work.empty()) layers.work.at(p.x, p.y) = ray_work + static_cast<float>(steps[i]) / samples_float;
        for (size_t k = 0; k < part_count; ++k)
            task.parts[k]->at(p.x, p.y) += part_sums[i * part_count + k] / samples_float;
    }
}
}

void FrameStats::drop(ivec2 pixel, uint64_t count) {
    FrameStats one;
    one.non_finite = count, one.first_non_finite = pixel;
    add(one);
}

void FrameStats::add(const FrameStats& other) {
    prepare_seconds += other.prepare_seconds, render_seconds += other.render_seconds;
    fog_seconds += other.fog_seconds;
    camera_rays += other.camera_rays, steps += other.steps;
    const ivec2 a = other.first_non_finite, b = first_non_finite;
    if (other.non_finite && (non_finite == 0 || a.y < b.y || (a.y == b.y && a.x < b.x))) first_non_finite = a;
    non_finite += other.non_finite, samples += other.samples, moments = std::max(moments, other.moments);
}

void FrameStats::add_lost(const FrameStats& missed) {
    prepare_seconds += missed.prepare_seconds, render_seconds += missed.render_seconds;
    fog_seconds += missed.fog_seconds;
    camera_rays += missed.camera_rays, steps += missed.steps;
    const double seconds = missed.goal_seconds + forecast_seconds;
    const bool is_early = forecast_seconds > 0 && missed.goal_seconds <= early_share_of_time * seconds;
    forecast_seconds = is_early || missed.forecast_seconds == infinity ? seconds : missed.forecast_seconds;
    goal_seconds += missed.goal_seconds;
}

std::optional<Noise> FrameStats::error() const {
    if (!noise) return noise;
    const Noise none, &systematic = integrator ? integrator->error : none, &grid = orders ? orders->pixels : none;
    const Noise& blur = moments_error ? *moments_error : none;
    return Noise{std::hypot(std::hypot(noise->error, systematic.error, grid.error), blur.error),
                 std::hypot(std::hypot(noise->bound, systematic.bound, grid.bound), blur.bound)};
}

namespace {
Layers render_pixels(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings,
                     const FrameOptions& options, FrameStats& stats) {
    View view = given;
    assert(view.pixel_samples > 0 && view.batches > 0 && view.pixel_samples % view.batches == 0);
    const double start = steady_seconds();
    FrameTask task = make_task(mode, view, snapshot, settings, options);
    find_parts(view, view.fog_parts ? light_layers(snapshot) : LightLayers{}, task);
    const double prepared = steady_seconds();

    Layers& layers = task.layers;
    FrameStats probed;
    if (mode.surfaces == Surfaces::shared) view.edges = edge_factors(task, probed);
    const auto render = view.leaves > 0 ? render_grouped_tile : render_tile;
    stats = for_each_tile(
        layers, options,
        [&](const PixelTile& tile, int64_t, FrameStats& block_stats) { render(task, tile, layers, block_stats); },
        view.sparse);
    if (view.sparse) spread_pixels(layers);
    stats.moments = static_cast<int>(std::max<size_t>(task.prepared->moments.size(), 1));
    stats.samples = view.leaves > 0 ? mean_samples(stats.camera_rays, layers) : view.pixel_samples;
    stats.prepare_seconds = prepared - start;
    stats.render_seconds = steady_seconds() - prepared;
    stats.fog_seconds = task.mode_seconds + *task.fog_seconds / thread_count();
    stats.add(probed);
    add_up(layers);
    if (view.batches * view.sections > 1) stats.noise = noise_of(layers);
    return std::move(task.layers);
}

// Crops an image to a window.
template<class T> void crop(Image<T>& image, ivec2 low, ivec2 size) {
    if (image.empty()) return;
    Image<T> part(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) part.at(x, y) = image.at(low.x + x, low.y + y);
    image = std::move(part);
}

void crop(Layers& layers, ivec2 low, ivec2 high) {
    const ivec2 size = high - low;
    for (Image<vec3>* image : {&layers.color, &layers.inscatter, &layers.surface, &layers.background, &layers.ambient,
                               &layers.emission, &layers.multiple, &layers.channel_transmittance})
        crop(*image, low, size);
    for (Image<float>* image : {&layers.alpha, &layers.depth, &layers.transmittance, &layers.validity})
        crop(*image, low, size);
    for (auto& [name, image] : layers.lights) crop(image, low, size);
    layers.low = low, layers.size = size;
}

void add(const Image<vec3>& part, Image<vec3>& sum) {
    for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += part.pixels[i];
}

}

View view_before_post(const View& view) {
    View whole = view;
    whole.crop_low = whole.crop_high = ivec2(0);
    whole.covered = view.background, whole.background = true, whole.surface_parts = true;
    return whole;
}

void add_post(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, Layers& layers,
              FrameStats& stats) {
    const double start = steady_seconds();
    const PostOutput addition = mode.prepare_post(view, snapshot, settings)({layers.color, layers.alpha, layers.depth});
    add(addition.radiance, layers.inscatter);
    for (size_t i = 0; i < layers.validity.pixels.size(); ++i)
        layers.validity.pixels[i] = std::min(layers.validity.pixels[i], addition.validity.pixels[i]);
    if (view.fog_parts) {
        const std::vector<int> lights = layers_of_lights(light_layers(snapshot), snapshot);
        for (size_t l = 0; l < addition.per_light.size(); ++l)
            add(addition.per_light[l], layers.lights[static_cast<size_t>(lights[l])].second);
    }
    if (!view.background) std::ranges::fill(layers.background.pixels, vec3(0));
    add_up(layers);
    const double seconds = steady_seconds() - start;
    stats.render_seconds += seconds, stats.fog_seconds += seconds;
    if (view.crop_low != view.crop_high) crop(layers, view.crop_low, view.crop_high);
}

void cover_background(const View& view, const Snapshot& snapshot, Layers& layers) {
    if (view.background && has_background(snapshot.background) && !has_mattes(snapshot))
        std::ranges::fill(layers.alpha.pixels, 1.0f);
}

void prepare_files(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings) {
    CacheFolder* folder = snapshot.files.get();
    View view = mode.surfaces == Surfaces::post ? view_before_post(given) : given;
    double start = steady_seconds();
    if (mode.surfaces == Surfaces::shared) {
        view.lamps = lamps_in(view, snapshot);
        record_cost(folder, "lamps in view", steady_seconds() - start);
    }
    start = steady_seconds();
    const double noted = rebuild_seconds(folder);
    const FrameTask task = make_task(mode, view, snapshot, settings, {});
    record_cost(folder, mode.name, steady_seconds() - start - (rebuild_seconds(folder) - noted));
    FrameStats probed;
    if (mode.surfaces == Surfaces::shared) edge_factors(task, probed);
}

Layers render_frame(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options, FrameStats& stats) {
    const bool post = mode.surfaces == Surfaces::post;
    View view = given;
    if (mode.surfaces == Surfaces::shared) view.lamps = lamps_in(view, snapshot);
    Layers layers = render_pixels(mode, post ? view_before_post(view) : view, snapshot, settings, options, stats);
    if (post) add_post(mode, view, snapshot, settings, layers, stats);
    cover_background(view, snapshot, layers);
    return layers;
}
}

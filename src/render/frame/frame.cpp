// The pixel loop: blocks of pixels in parallel, each pixel owned by one task and filtered in sample order.
#include "render/frame/frame.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/parallel.h"
#include "modes/mode.h"
#include "render/frame/edges.h"
#include "render/frame/layers.h"
#include "render/frame/pixel_sum.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "trace/sampling/lamp_samples.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
constexpr int tile_side = 4;   // a tile's 16 rays are traced together
constexpr int block_side = 32; // a task's pixels

// What all blocks of a frame share.
struct FrameTask {
    std::shared_ptr<const Prepared> prepared; // holds what the tracer points at
    FrameTracer tracer;
    double mode_seconds = 0;                              // its preparation
    std::shared_ptr<std::atomic<double>> scatter_seconds; // then, of all threads
    Layers layers;
    std::vector<Image<vec3>*> parts; // of the layers: where the parts of fog light go; empty unless asked for
};

Layers make_layers(const View& view, bool halves) {
    const bool cropped = view.crop_low != view.crop_high;
    Layers layers;
    layers.display = view.size;
    layers.low = cropped ? view.crop_low : ivec2(0);
    layers.size = (cropped ? view.crop_high : view.size) - layers.low;
    assert(layers.size.x > 0 && layers.size.y > 0 && layers.low.x >= 0 && layers.low.y >= 0);
    assert(layers.low.x + layers.size.x <= view.size.x && layers.low.y + layers.size.y <= view.size.y);
    layers.color = layers.inscatter = Image<vec3>(layers.size);
    layers.alpha = layers.transmittance = layers.validity = layers.depth = Image<float>(layers.size);
    if (view.batches > 1) {
        layers.variance = layers.inscatter_variance = Image<vec3>(layers.size);
        layers.variance_error = layers.inscatter_variance_error = layers.work = Image<float>(layers.size);
    }
    if (view.surface_parts || view.fog_parts) layers.surface = layers.background = Image<vec3>(layers.size);
    if (view.fog_parts) layers.ambient = layers.emission = layers.multiple = Image<vec3>(layers.size);
    if (halves) layers.half_a = layers.half_b = Image<vec3>(layers.size);
    return layers;
}

// Where the parts of fog light go. Lights of one name share a layer; dark lights of the scene have theirs, so that
// every frame holds the same layers.
std::vector<Image<vec3>*> make_parts(const Snapshot& snapshot, Layers& layers) {
    const auto find_or_add = [&](const std::string& name) {
        for (size_t i = 0; i < layers.lights.size(); ++i)
            if (layers.lights[i].first == name) return i;
        layers.lights.emplace_back(name, Image<vec3>(layers.size));
        return layers.lights.size() - 1;
    };
    if (snapshot.scene)
        for (const LightSource& light : snapshot.scene->lights) find_or_add(light.name);
    std::vector<size_t> places;
    for (const Light& light : snapshot.lights) places.push_back(find_or_add(light.name));
    std::vector<Image<vec3>*> result;
    for (const size_t place : places) result.push_back(&layers.lights[place].second);
    result.insert(result.end(), {&layers.ambient, &layers.emission, &layers.multiple});
    return result;
}

bool contains(const Layers& layers, ivec2 pixel) {
    const ivec2 p = pixel - layers.low;
    return p.x >= 0 && p.y >= 0 && p.x < layers.size.x && p.y < layers.size.y;
}

void count_dropped(ivec2 pixel, FrameStats& stats) {
    FrameStats one;
    one.non_finite = 1, one.first_non_finite = pixel;
    stats.add(one);
}

// Traces all pixels of a tile, also those outside the crop: a mode may let neighbours share steps.
void render_tile(const FrameTask& task, ivec2 corner, Layers& layers, FrameStats& stats) {
    const View& view = task.tracer.view;
    const ivec2 end = glm::min(corner + tile_side, view.size);
    ivec2 pixels[16];
    size_t count = 0;
    bool wanted = false;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) {
            pixels[count++] = {x, y};
            wanted |= contains(layers, {x, y});
        }
    if (!wanted) return;

    const size_t part_count = task.parts.size();
    const int sample_count = samples_of(view, corner), batch_size = sample_count / batches_of(view, corner);
    if (sample_count == 0) return; // the picture is a part of one in which the tile has all it needs
    PixelSum sums[16];
    PixelSample samples[16];
    int64_t steps[16] = {};
    std::vector<vec3> fog_parts(part_count * count), part_sums(part_count * count, vec3(0));
    for (int s = 0; s < sample_count; ++s) {
        trace_samples(task.tracer, {pixels, count}, s, {samples, count}, fog_parts);
        for (size_t i = 0; i < count; ++i) {
            if (!contains(layers, pixels[i])) continue;
            ++stats.camera_rays, steps[i] += samples[i].steps;
            const std::span<const vec3> parts{fog_parts.data() + i * part_count, part_count};
            if (!samples[i].finite() || !std::ranges::all_of(parts, is_finite)) {
                count_dropped(pixels[i], stats);
                continue;
            }
            sums[i].add(samples[i]);
            for (size_t k = 0; k < part_count; ++k) part_sums[i * part_count + k] += parts[k];
        }
        if ((s + 1) % batch_size) continue;
        for (size_t i = 0; i < count; ++i) sums[i].end_batch(batch_size);
    }

    const float samples_float = static_cast<float>(sample_count);
    for (size_t i = 0; i < count; ++i) {
        if (!contains(layers, pixels[i])) continue;
        const ivec2 p = pixels[i] - layers.low;
        store_pixel(sums[i], sample_count, p, layers);
        stats.steps += static_cast<uint64_t>(steps[i]);
        if (!layers.work.empty()) layers.work.at(p.x, p.y) = ray_work + static_cast<float>(steps[i]) / samples_float;
        for (size_t k = 0; k < part_count; ++k)
            task.parts[k]->at(p.x, p.y) += part_sums[i * part_count + k] / samples_float;
    }
}

// Counts the time of every call.
ScatterFunction timed(ScatterFunction scatter, std::shared_ptr<std::atomic<double>> seconds) {
    return [scatter = std::move(scatter), seconds](const RayBatch& batch, std::span<Scatter> results) {
        const double start = steady_seconds();
        scatter(batch, results);
        seconds->fetch_add(steady_seconds() - start, std::memory_order_relaxed);
    };
}

FrameTask make_task(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options) {
    // Named one by one: g++ 12 destroys members of a nested braced initialiser twice when a later one throws.
    Layers layers = make_layers(view, options.halves);
    std::shared_ptr<const Prepared> prepared = options.prepared;
    if (!prepared)
        prepared = std::make_shared<const Prepared>(prepare_frame(mode, view, snapshot, settings, options.history));
    auto scatter_seconds = std::make_shared<std::atomic<double>>(0);
    FrameTask task{prepared,
                   {view, snapshot, timed(prepared->scatter, scatter_seconds), mode.surfaces,
                    settings.terms.light_points, prepared->light_depths},
                   options.prepared ? 0 : prepared->mode_seconds,
                   scatter_seconds,
                   std::move(layers),
                   {}};
    return task;
}

}

Prepared prepare_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                       History* history) {
    const double start = steady_seconds();
    Prepared result{mode.prepare(view, snapshot, settings, history), {}, 0};
    result.mode_seconds = steady_seconds() - start;
    if (mode.surfaces != Surfaces::own && snapshot.occluders && !snapshot.occluders->empty())
        for (const Light& light : snapshot.lights)
            result.light_depths.push_back(
                make_light_depth(snapshot, light, settings.terms.light, settings.terms.light_resolution, &view));
    return result;
}

void FrameStats::add(const FrameStats& other) {
    prepare_seconds += other.prepare_seconds, render_seconds += other.render_seconds;
    fog_seconds += other.fog_seconds;
    camera_rays += other.camera_rays, steps += other.steps;
    const ivec2 a = other.first_non_finite, b = first_non_finite;
    if (other.non_finite && (non_finite == 0 || a.y < b.y || (a.y == b.y && a.x < b.x))) first_non_finite = a;
    non_finite += other.non_finite, samples += other.samples;
}

std::optional<Noise> FrameStats::error() const {
    if (!noise) return noise;
    const Noise none, &systematic = integrator ? integrator->error : none, &grid = orders ? orders->tiles : none;
    return Noise{std::hypot(noise->error, systematic.error, grid.error),
                 std::hypot(noise->bound, systematic.bound, grid.bound)};
}

namespace {
Layers render_pixels(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings,
                     const FrameOptions& options, FrameStats& stats) {
    View view = given;
    assert(view.pixel_samples > 0 && view.batches > 0 && view.pixel_samples % view.batches == 0);
    const double start = steady_seconds();
    FrameTask task = make_task(mode, view, snapshot, settings, options);
    if (view.fog_parts) task.parts = make_parts(snapshot, task.layers);
    const double prepared = steady_seconds();

    // Blocks lie on a grid of the full picture, so that tiles do not depend on the crop.
    Layers& layers = task.layers;
    FrameStats probed;
    if (mode.surfaces == Surfaces::shared)
        view.edges = edge_factors(task.tracer, layers.low, layers.low + layers.size, probed);
    const ivec2 first = layers.low / block_side, last = (layers.low + layers.size - 1) / block_side;
    const ivec2 blocks = last - first + 1;
    const int64_t block_count = int64_t{blocks.x} * blocks.y;
    std::vector<FrameStats> block_stats(static_cast<size_t>(block_count));
    std::atomic<int64_t> done = 0;
    parallel_for(block_count, [&](int64_t b) {
        const ivec2 low = (first + ivec2(b % blocks.x, b / blocks.x)) * block_side;
        const ivec2 high = glm::min(low + block_side, view.size);
        for (int y = low.y; y < high.y; y += tile_side)
            for (int x = low.x; x < high.x; x += tile_side) {
                if (options.cancel && *options.cancel) fail(ExitCode::internal, "render", "cancelled");
                render_tile(task, {x, y}, layers, block_stats[static_cast<size_t>(b)]);
            }
        if (options.progress) options.progress(static_cast<double>(++done) / static_cast<double>(block_count));
    });

    stats = {};
    stats.prepare_seconds = prepared - start;
    stats.render_seconds = steady_seconds() - prepared;
    stats.samples = view.pixel_samples;
    stats.fog_seconds = task.mode_seconds + *task.scatter_seconds / thread_count();
    for (const FrameStats& block : block_stats) stats.add(block);
    stats.add(probed);
    add_up(layers);
    if (view.batches > 1) stats.noise = noise_of(layers);
    return std::move(task.layers);
}

// The part of an image a crop window shows.
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
                               &layers.emission, &layers.multiple})
        crop(*image, low, size);
    for (Image<float>* image : {&layers.alpha, &layers.depth, &layers.transmittance, &layers.validity})
        crop(*image, low, size);
    for (auto& [name, image] : layers.lights) crop(image, low, size);
    layers.low = low, layers.size = size;
}

void add(const Image<vec3>& part, Image<vec3>& sum) {
    for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += part.pixels[i];
}

// The whole picture without fog light first: what the mode adds to a pixel depends on others, and on the background
// even where that is left out.
Layers render_post(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                   const FrameOptions& options, FrameStats& stats) {
    View whole = view;
    whole.crop_low = whole.crop_high = ivec2(0);
    whole.background = true, whole.surface_parts = true;
    Layers layers = render_pixels(mode, whole, snapshot, settings, options, stats);

    const double start = steady_seconds();
    const Addition addition = mode.prepare_post(view, snapshot, settings)({layers.color, layers.alpha, layers.depth});
    add(addition.radiance, layers.inscatter);
    for (size_t i = 0; i < layers.validity.pixels.size(); ++i)
        layers.validity.pixels[i] = std::min(layers.validity.pixels[i], addition.validity.pixels[i]);
    if (view.fog_parts) {
        const std::vector<Image<vec3>*> parts = make_parts(snapshot, layers);
        for (size_t l = 0; l < addition.per_light.size(); ++l) add(addition.per_light[l], *parts[l]);
    }
    if (!view.background) std::ranges::fill(layers.background.pixels, vec3(0));
    add_up(layers);
    const double seconds = steady_seconds() - start;
    stats.render_seconds += seconds, stats.fog_seconds += seconds;
    if (view.crop_low != view.crop_high) crop(layers, view.crop_low, view.crop_high);
    return layers;
}
}

Layers render_frame(const Mode& mode, const View& given, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options, FrameStats& stats) {
    const bool post = mode.surfaces == Surfaces::post;
    View view = given;
    if (mode.surfaces == Surfaces::shared) view.lamps = lamps_in(view, snapshot);
    Layers layers = (post ? render_post : render_pixels)(mode, view, snapshot, settings, options, stats);
    if (view.background && has_background(snapshot.background)) std::ranges::fill(layers.alpha.pixels, 1.0f);
    return layers;
}
}

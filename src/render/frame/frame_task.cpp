#include "render/frame/frame_task.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/process.h"
#include "base/random.h"
#include "base/text.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/frame/channels.h"
#include "scene/scene.h"
#include "trace/mattes.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tyndall {
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
    if (view.batches * view.sections > 1) {
        layers.variance = layers.inscatter_variance = Image<vec3>(layers.size);
        layers.variance_error = layers.inscatter_variance_error = layers.work = Image<float>(layers.size);
    }
    if (view.before) layers.apart = layers.inscatter_apart = Image<vec3>(layers.size);
    if (view.surface_parts || view.fog_parts) layers.surface = layers.background = Image<vec3>(layers.size);
    if (view.fog_parts) layers.ambient = layers.emission = layers.multiple = Image<vec3>(layers.size);
    if (halves) layers.half_a = layers.half_b = Image<vec3>(layers.size);
    return layers;
}

LightLayers light_layers(const Snapshot& snapshot) {
    LightLayers result;
    const auto find_or_add = [&](const std::string& name) {
        for (size_t i = 0; i < result.names.size(); ++i)
            if (result.names[i] == name) return static_cast<int>(i);
        result.names.push_back(name);
        return static_cast<int>(result.names.size()) - 1;
    };
    if (snapshot.scene)
        for (const LightSource& light : snapshot.scene->lights) find_or_add(light.name);
    for (const Light& light : snapshot.lights) result.of_light.push_back(find_or_add(light.name));
    if (!snapshot.moments) return result;
    for (const Snapshot& moment : *snapshot.moments)
        for (const Light& light : moment.lights) find_or_add(light.name);
    result.of_light.resize(result.names.size());
    std::iota(result.of_light.begin(), result.of_light.end(), 0);
    return result;
}

std::vector<int> layers_of_lights(const LightLayers& layers, const Snapshot& snapshot) {
    std::vector<int> result;
    for (const Light& light : snapshot.lights)
        result.push_back(static_cast<int>(std::ranges::find(layers.names, light.name) - layers.names.begin()));
    return result;
}

std::vector<Image<vec3>*> add_light_layers(const LightLayers& lights, Layers& layers) {
    for (const std::string& name : lights.names) layers.lights.emplace_back(name, Image<vec3>(layers.size));
    std::vector<Image<vec3>*> result;
    for (const int light : lights.of_light) result.push_back(&layers.lights[static_cast<size_t>(light)].second);
    result.insert(result.end(), {&layers.ambient, &layers.emission, &layers.multiple});
    return result;
}

bool has_channel_layer(const Snapshot& snapshot) {
    return is_chromatic(snapshot) || (snapshot.scene && has_colored_fog(*snapshot.scene));
}

void find_parts(const View& view, const LightLayers& lights, FrameTask& task) {
    if (view.fog_parts) task.parts = add_light_layers(lights, task.layers);
    task.fog_parts = task.parts.size();
    if (!task.layers.channel_transmittance.empty()) task.parts.push_back(&task.layers.channel_transmittance);
}

bool contains(const Layers& layers, ivec2 pixel) {
    const ivec2 p = pixel - layers.low;
    return p.x >= 0 && p.y >= 0 && p.x < layers.size.x && p.y < layers.size.y;
}

namespace {
// Whether alpha has to account for mattes that hold out the background.
bool counts_holdout(const Snapshot& snapshot) { return has_background(snapshot.background) && has_mattes(snapshot); }
}

FrameTask make_task(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options) {
    // Local variables first: g++ 12 destroys members of a nested braced initializer twice when a later one throws.
    Layers layers = make_layers(view, options.halves);
    if (has_channel_layer(snapshot)) layers.channel_transmittance = Image<vec3>(layers.size);
    std::shared_ptr<const Prepared> prepared = options.prepared;
    if (!prepared)
        prepared = std::make_shared<const Prepared>(prepare_frame(mode, view, snapshot, settings, options.history));
    auto fog_seconds = std::make_shared<std::atomic<double>>(0);
    FrameTracer tracer = frame_tracer(mode, view, snapshot, settings, *prepared);
    tracer.covered = view.background && view.covered && counts_holdout(snapshot),
    tracer.fog_seconds = fog_seconds.get();
    const double mode_seconds = options.prepared ? 0 : prepared->mode_seconds;
    FrameTask task{prepared, fog_seconds, tracer, mode_seconds, std::move(layers), {}, {}, 0, options.cancel};
    if (snapshot.files) {
        task.made_by = mode.name;
        for (const SettingRow& row : setting_rows()) task.made_by += " " + row.name + "=" + row.get(settings);
    }
    return task;
}

bool has_moments(const View& view, const Snapshot& snapshot) {
    return view.shutter && snapshot.moments && view.shutter->cameras.size() == snapshot.moments->size();
}

namespace {
// Fails if all moments, judged by the first few, would not fit into memory.
void check_memory(double before, size_t prepared, size_t moments) {
    constexpr double max_share = 0.8, gibibyte = 1 << 30;
    const double machine = static_cast<double>(physical_memory());
    const double one = (static_cast<double>(resident_memory()) - before) / static_cast<double>(prepared);
    const double all = before + static_cast<double>(moments) * one;
    if (machine > 0 && all > max_share * machine)
        fail(ExitCode::out_of_memory, "motion blur",
             formatted("%zu moments would take about %.1f GiB in this mode, and the machine has %.1f GiB: use fewer "
                       "--time-samples, or smaller maps and grids",
                       moments, all / gibibyte, machine / gibibyte));
}
}

Prepared prepare_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                       History* history) {
    if (!has_moments(view, snapshot)) return prepare_moment(mode, view, snapshot, settings, history);
    assert(!history); // a history is kept from frame to frame, not from moment to moment
    Prepared result;
    const LightLayers layers = light_layers(snapshot);
    View at_moment = view;
    at_moment.shutter = nullptr;
    const double held = static_cast<double>(resident_memory());
    for (size_t i = 0; i < snapshot.moments->size(); ++i) {
        const Snapshot& moment = (*snapshot.moments)[i];
        at_moment.camera = view.shutter->cameras[i];
        Prepared& prepared = result.moments.emplace_back(prepare_moment(mode, at_moment, moment, settings, nullptr));
        prepared.layer_of_light = layers_of_lights(layers, moment);
        result.mode_seconds += prepared.mode_seconds;
        if (i == 1) check_memory(held, i + 1, snapshot.moments->size());
    }
    return result;
}

namespace {
constexpr int block_side = 32; // pixels

// Blocks lie on a grid of the full image, so that tiles do not depend on the crop.
struct Blocks {
    ivec2 first, count;

    int64_t all() const { return int64_t{count.x} * count.y; }
    ivec2 corner(int64_t block) const { return (first + ivec2(block % count.x, block / count.x)) * block_side; }
};

Blocks blocks_of(ivec2 low, ivec2 size) {
    const ivec2 first = low / block_side;
    return {first, (low + size - 1) / block_side - first + 1};
}

constexpr uint32_t use_sparse = 0x59a5u;

// The pixel of each 2×2 that sparse tiles have: another one in each tile, so that no column or row is always left out.
ivec2 sparse_pixel(ivec2 corner, const Layers& layers) {
    const ivec2 tile = corner / tile_side;
    const uint32_t u = hash(static_cast<uint32_t>(tile.x), static_cast<uint32_t>(tile.y), use_sparse);
    return glm::clamp(corner + ivec2(u & 1, u >> 1 & 1), layers.low, layers.low + layers.size - 1);
}

PixelTile sparse_tile_at(ivec2 corner, const Layers& layers) {
    PixelTile tile{corner, {}, 0};
    for (int y = corner.y; y < corner.y + 2 * tile_side; y += 2)
        for (int x = corner.x; x < corner.x + 2 * tile_side; x += 2)
            if (glm::all(glm::lessThan(ivec2(x, y), layers.low + layers.size)) &&
                glm::all(glm::greaterThan(ivec2(x, y) + 2, layers.low)))
                tile.pixels[tile.count++] = sparse_pixel({x, y}, layers);
    return tile;
}

PixelTile tile_at(ivec2 corner, ivec2 display) {
    PixelTile tile{corner, {}, 0};
    const ivec2 end = glm::min(corner + tile_side, display);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) tile.pixels[tile.count++] = {x, y};
    return tile;
}
}

int64_t count_blocks(ivec2 low, ivec2 size) { return blocks_of(low, size).all(); }

void spread_pixels(Layers& layers) {
    const auto spread = [&](auto& image) {
        if (image.empty()) return;
        for (int y = 0; y < layers.size.y; ++y)
            for (int x = 0; x < layers.size.x; ++x) {
                const ivec2 from = sparse_pixel((layers.low + ivec2(x, y)) / 2 * 2, layers) - layers.low;
                image.at(x, y) = image.at(from.x, from.y);
            }
    };
    for (Image<vec3>* image : {&layers.color, &layers.inscatter, &layers.variance, &layers.inscatter_variance})
        spread(*image);
    for (Image<float>* image : {&layers.variance_error, &layers.inscatter_variance_error, &layers.work}) spread(*image);
}

FrameStats for_each_tile(const Layers& layers, const FrameOptions& options,
                         const std::function<void(const PixelTile&, int64_t, FrameStats&)>& render, bool sparse) {
    const int side = sparse ? 2 * tile_side : tile_side;
    const Blocks blocks = blocks_of(layers.low, layers.size);
    std::vector<FrameStats> block_stats(static_cast<size_t>(blocks.all()));
    std::atomic<int64_t> done = 0;
    parallel_for(blocks.all(), [&](int64_t b) {
        const ivec2 low = blocks.corner(b), high = glm::min(low + block_side, layers.display);
        for (int y = low.y; y < high.y; y += side)
            for (int x = low.x; x < high.x; x += side) {
                if (options.cancel && *options.cancel) fail(ExitCode::internal, "render", "cancelled");
                const PixelTile tile = sparse ? sparse_tile_at({x, y}, layers) : tile_at({x, y}, layers.display);
                if (std::any_of(tile.pixels, tile.pixels + tile.count, [&](ivec2 p) { return contains(layers, p); }))
                    render(tile, b, block_stats[static_cast<size_t>(b)]);
            }
        if (options.progress) options.progress(static_cast<double>(++done) / static_cast<double>(blocks.all()));
    });
    FrameStats stats;
    for (const FrameStats& block : block_stats) stats.add(block);
    return stats;
}
}

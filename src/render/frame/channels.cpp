#include "render/frame/channels.h"

#include "base/clock.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/surface.h"
#include "trace/transmittance/light_depth.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
namespace {
Prepared prepare_gray(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                      History* history) {
    const double start = steady_seconds();
    Prepared result;
    result.scatter = mode.prepare(view, snapshot, settings, history);
    result.mode_seconds = steady_seconds() - start;
    if (mode.surfaces == Surfaces::own || !snapshot.occluders || snapshot.occluders->empty()) return result;
    for (const Light& light : snapshot.lights)
        result.light_depths.push_back(
            make_light_depth(snapshot, light, settings.terms.light, settings.terms.light_resolution, &view));
    if (settings.terms.emission) result.emitters = emitters_of(snapshot);
    return result;
}

// Whether a mode that can trace all channels together does: where extinctions are further apart than this, paths by one
// channel say too little about the others (with 15 to 1, single scattering takes 40 % of the time for the same noise;
// with 400 to 1, three times as long).
bool traces_together(const Mode& mode, const Snapshot& snapshot) {
    constexpr float max_ratio = 30;
    return mode.traces_channels && std::ranges::all_of(snapshot.media, [](const Medium& medium) {
               const vec3 channels = medium.optics.channels;
               return max_component(channels) <= max_ratio * std::min({channels.x, channels.y, channels.z});
           });
}

// Copies channel `c` from the result of its scene.
void take_channel(const Scatter& from, glm::length_t c, Scatter& to) {
    to.radiance[c] = from.radiance[c], to.surface[c] = from.surface[c], to.background[c] = from.background[c];
    to.tint[c] = from.transmittance, to.steps += from.steps;
    to.validity = std::min(to.validity, from.validity);
    to.holdout += from.holdout / 3;
}

ScatterFunction combine_channels(std::vector<ScatterFunction> channels) {
    return [channels = std::move(channels)](const RayBatch& batch, std::span<Scatter> results) {
        std::ranges::fill(results, Scatter());
        std::vector<Scatter> found(results.size());
        std::vector<vec3> parts(batch.parts.size());
        for (glm::length_t c = 0; c < 3; ++c) {
            RayBatch own = batch;
            std::ranges::fill(parts, vec3(0));
            own.parts = parts;
            channels[static_cast<size_t>(c)](own, found);
            for (size_t i = 0; i < results.size(); ++i) take_channel(found[i], c, results[i]);
            for (size_t i = 0; i < parts.size(); ++i) batch.parts[i][c] += parts[i][c];
        }
        for (Scatter& result : results) {
            result.transmittance = mean_component(result.tint);
            result.tint = result.transmittance > 0 ? result.tint / result.transmittance : vec3(1);
        }
    };
}
}

Prepared prepare_moment(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        History* history) {
    if (!is_chromatic(snapshot) || traces_together(mode, snapshot))
        return prepare_gray(mode, view, snapshot, settings, history);
    Prepared result;
    std::vector<ScatterFunction> channels;
    for (int c = 0; c < 3; ++c) {
        const auto scene = std::make_shared<const Snapshot>(channel_of(snapshot, c));
        Prepared channel = prepare_gray(mode, view, *scene, settings, nullptr);
        channel.channel = scene;
        result.emitters = channel.emitters;
        channels.push_back(channel.scatter);
        result.mode_seconds += channel.mode_seconds;
        result.channels.push_back(std::move(channel));
    }
    result.scatter = combine_channels(std::move(channels));
    return result;
}

namespace {
void shade_gray(const Snapshot& snapshot, const Prepared& prepared, std::span<const SurfacePoint> points,
                std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light) {
    shade_surfaces(snapshot, prepared.light_depths, points, u, radiance, per_light);
    if (prepared.emitters) add_emitted_light(prepared.emitters, snapshot, points, u, radiance);
}
}

void shade(const Snapshot& snapshot, const Prepared& prepared, std::span<const SurfacePoint> points,
           std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light) {
    if (prepared.channels.empty()) return shade_gray(snapshot, prepared, points, u, radiance, per_light);
    std::vector<vec3> found(points.size()), of_lights;
    for (glm::length_t c = 0; c < 3; ++c) {
        const Prepared& channel = prepared.channels[static_cast<size_t>(c)];
        shade_gray(*channel.channel, channel, points, u, found, per_light ? &of_lights : nullptr);
        for (size_t i = 0; i < found.size(); ++i) radiance[i][c] = found[i][c];
        if (!per_light) continue;
        per_light->resize(of_lights.size());
        for (size_t i = 0; i < of_lights.size(); ++i) (*per_light)[i][c] = of_lights[i][c];
    }
}
}

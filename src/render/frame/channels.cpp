#include "render/frame/channels.h"

#include "base/clock.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/surface.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Of every light, for surfaces that the mode does not shade itself.
std::vector<LightDepth> surface_depths(const Mode& mode, const View& view, const Snapshot& snapshot,
                                       const Settings& settings) {
    std::vector<LightDepth> depths;
    if (mode.surfaces == Surfaces::own || !snapshot.occluders || snapshot.occluders->empty()) return depths;
    for (const Light& light : snapshot.lights)
        depths.push_back(
            make_light_depth(snapshot, light, settings.terms.light, settings.terms.light_resolution, &view));
    return depths;
}

// Takes channel `c` of what one of the three has found.
void take_channel(const Scatter& from, glm::length_t c, Scatter& to) {
    to.radiance[c] = from.radiance[c], to.surface[c] = from.surface[c], to.background[c] = from.background[c];
    to.tint[c] = from.transmittance, to.steps += from.steps;
    to.validity = std::min(to.validity, from.validity);
    to.held += from.held / 3;
}

ScatterFunction together(std::shared_ptr<const std::vector<PreparedChannel>> channels) {
    return [channels = std::move(channels)](const RayBatch& batch, std::span<Scatter> results) {
        std::ranges::fill(results, Scatter());
        std::vector<Scatter> found(results.size());
        std::vector<vec3> parts(batch.parts.size());
        for (glm::length_t c = 0; c < 3; ++c) {
            RayBatch own = batch;
            std::ranges::fill(parts, vec3(0));
            own.parts = parts;
            (*channels)[static_cast<size_t>(c)].scatter(own, found);
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

Prepared prepare_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                       History* history) {
    const double start = steady_seconds();
    Prepared result;
    if (is_chromatic(snapshot)) {
        auto channels = std::make_shared<std::vector<PreparedChannel>>(3);
        for (int c = 0; c < 3; ++c) {
            PreparedChannel& channel = (*channels)[static_cast<size_t>(c)];
            channel.snapshot = channel_of(snapshot, c);
            channel.scatter = mode.prepare(view, channel.snapshot, settings, nullptr);
        }
        result.channels = channels, result.scatter = together(channels);
        result.mode_seconds = steady_seconds() - start;
        for (PreparedChannel& channel : *channels)
            channel.light_depths = surface_depths(mode, view, channel.snapshot, settings);
        return result;
    }
    result.scatter = mode.prepare(view, snapshot, settings, history);
    result.mode_seconds = steady_seconds() - start;
    result.light_depths = surface_depths(mode, view, snapshot, settings);
    return result;
}

void shade(const Snapshot& snapshot, const Prepared& prepared, std::span<const SurfacePoint> points,
           std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light) {
    if (!prepared.channels) return shade_surfaces(snapshot, prepared.light_depths, points, u, radiance, per_light);
    std::vector<vec3> found(points.size()), of_lights;
    for (glm::length_t c = 0; c < 3; ++c) {
        const PreparedChannel& channel = (*prepared.channels)[static_cast<size_t>(c)];
        shade_surfaces(channel.snapshot, channel.light_depths, points, u, found, per_light ? &of_lights : nullptr);
        for (size_t i = 0; i < found.size(); ++i) radiance[i][c] = found[i][c];
        if (!per_light) continue;
        per_light->resize(of_lights.size());
        for (size_t i = 0; i < of_lights.size(); ++i) (*per_light)[i][c] = of_lights[i][c];
    }
}
}

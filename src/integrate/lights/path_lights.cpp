#include "integrate/lights/path_lights.h"

#include "integrate/terms.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <optional>

namespace tyndall {
std::shared_ptr<const ScatteringFog> scattering_fog(const Snapshot& snapshot, const StyleSettings& style,
                                                    const TermSettings& terms, const Camera& camera,
                                                    float min_transmittance) {
    auto fog = std::make_shared<ScatteringFog>(ScatteringFog{{}, {}, style, camera});
    for (const Medium& medium : snapshot.media) {
        if (only_emits(medium.optics)) continue;
        fog->media.push_back(medium);
        fog->peaks.push_back(phase_peak(medium.optics.phase));
    }
    fog->light_depth = terms.light == LightTransmittance::off ? 0 : style.light_depth;
    fog->min_transmittance = min_transmittance, fog->points = terms.light_points;
    return fog;
}

float fade_at(const ScatteringFog& fog, vec3 point) {
    return fades(fog.style) ? style_fade(fog.style, eye_distance(fog.camera, point)) : 1;
}

namespace {
void trace_shadows(const Occluders& casters, std::span<const ScatterPath> paths, float* shares) {
    Occluders::ShadowRays rays{};
    for (size_t i = 0; i < paths.size(); ++i) rays.set(i, paths[i].shadow_ray);
    casters.transmission(rays, shares);
}

// True if any medium scatters light.
bool scatters(const ScatteringFog& fog) {
    return std::ranges::any_of(fog.media, [](const Medium& medium) { return max_component(medium.optics.albedo) > 0; });
}

// Traces the shadow rays of the paths and adds their light to the radiance of the camera rays, and to the light's part
// if parts are requested.
void add_paths(const ScatteringFog& fog, const PathLight& light, std::span<const ScatterPath> paths,
               const RayBatch& batch, std::span<Scatter> results) {
    const bool parts = !batch.parts.empty();
    const OtherLight* other = std::get_if<OtherLight>(&light.part);
    const size_t part = !parts ? 0 : other ? batch.index_of(*other) : std::get<size_t>(light.part);
    for (size_t first = 0; first < paths.size(); first += 16) {
        const auto some = paths.subspan(first, std::min<size_t>(16, paths.size() - first));
        alignas(64) float shares[16];
        std::fill_n(shares, 16, 1.0f);
        if (light.casters) trace_shadows(*light.casters, some, shares);
        for (size_t i = 0; i < some.size(); ++i) {
            const ScatterPath& path = some[i];
            ++results[path.ray].steps;
            if (!(shares[i] > 0)) continue;
            const double depth = fog.light_depth > 0 ? fog.light_depth * optical_depth(fog.media, path.shadow_ray) : 0;
            const vec3 added = path.light * (shares[i] * static_cast<float>(std::exp(-depth)));
            results[path.ray].radiance += added;
            if (parts) batch.part(path.ray, part) += added;
        }
    }
}

void add_path_lights(const ScatteringFog& fog, std::span<const PathLight> lights, const RayBatch& batch,
                     std::span<Scatter> results) {
    static thread_local FogPieces pieces[16];
    static thread_local std::vector<ScatterPath> paths;
    std::optional<FogSampler> seen[16]; // for rays that hit fog
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        find_fog(batch.rays[i], fog.media, fog.min_transmittance, pieces[i]);
        if (!pieces[i].pieces.empty() && pieces[i].depth > 0)
            seen[i].emplace(fog_sampler(pieces[i], fog.style.view_depth));
    }
    for (const PathLight& light : lights) {
        paths.clear();
        for (size_t i = 0; i < batch.rays.size(); ++i)
            if (seen[i]) light.append(batch, i, *seen[i], paths);
        add_paths(fog, light, paths, batch, results);
    }
}
}

ScatterFunction with_path_lights(std::shared_ptr<const ScatteringFog> fog, std::vector<PathLight> lights,
                                 ScatterFunction scatter) {
    if (lights.empty() || !scatters(*fog)) return scatter;
    return [fog = std::move(fog), lights = std::move(lights),
            scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        scatter(batch, results);
        add_path_lights(*fog, lights, batch, results);
    };
}
}

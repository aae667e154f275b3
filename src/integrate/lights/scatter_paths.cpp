#include "integrate/lights/scatter_paths.h"

#include "integrate/terms.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
ScatteringFog scattering_fog(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms,
                             const Camera& camera, float min_transmittance) {
    ScatteringFog fog{{}, style, camera};
    for (const Medium& medium : snapshot.media)
        if (!only_emits(medium.optics)) fog.media.push_back(medium);
    fog.light_depth = terms.light == LightTransmittance::off ? 0 : style.light_depth;
    fog.min_transmittance = min_transmittance, fog.points = terms.light_points;
    return fog;
}

bool scatters(const ScatteringFog& fog) {
    return std::ranges::any_of(fog.media, [](const Medium& medium) { return max_component(medium.optics.albedo) > 0; });
}

float shown_share(const ScatteringFog& fog, vec3 point) {
    return fades(fog.style) ? style_fade(fog.style, eye_distance(fog.camera, point)) : 1;
}

namespace {
void pass_surfaces(const Occluders& casters, std::span<const ScatterPath> paths, float* shares) {
    Occluders::ShadowRays rays{};
    for (size_t i = 0; i < paths.size(); ++i) rays.set(i, paths[i].way);
    casters.transmission(rays, shares);
}
}

void add_scatter_paths(const ScatteringFog& fog, const Occluders* casters, std::span<const ScatterPath> paths,
                       size_t part, const RayBatch& batch, std::span<Scatter> results) {
    for (size_t first = 0; first < paths.size(); first += 16) {
        const auto some = paths.subspan(first, std::min<size_t>(16, paths.size() - first));
        alignas(64) float shares[16];
        std::fill_n(shares, 16, 1.0f);
        if (casters) pass_surfaces(*casters, some, shares);
        for (size_t i = 0; i < some.size(); ++i) {
            const ScatterPath& path = some[i];
            ++results[path.ray].steps;
            if (!(shares[i] > 0)) continue;
            const double depth = fog.light_depth > 0 ? fog.light_depth * optical_depth(fog.media, path.way) : 0;
            const vec3 added = path.light * (shares[i] * static_cast<float>(std::exp(-depth)));
            results[path.ray].radiance += added;
            if (!batch.parts.empty()) batch.part(path.ray, part) += added;
        }
    }
}
}

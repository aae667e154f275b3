#include "integrate/environment_light.h"

#include "integrate/fog_points.h"
#include "integrate/terms.h"
#include "trace/environment.h"
#include "trace/occlusion/occluders.h"
#include "volume/phase.h"

#include <algorithm>
#include <utility>

namespace tyndall {
namespace {
enum Use : uint32_t { use_place = 0x5f1e, use_light, use_phase };

// A point of a ray, a direction from there, and what comes to the eye if nothing is in the way.
struct SkyPath {
    size_t ray = 0;
    vec3 point{0}, direction{0}, light{0};
};

// Picks a direction as the fog at the point scatters, of a medium by its share.
vec3 direction_by_phase(const std::vector<Medium>& media, const FogThere& fog, float which, vec2 u) {
    size_t m = 0;
    while (m + 1 < media.size() && which >= fog.shares[m]) which -= fog.shares[m++];
    while (m > 0 && !(fog.shares[m] > 0)) --m;
    return sample_phase(media[m].optics.phase, fog.direction, u);
}

// Both directions from one point; `weight`: of what is scattered there.
void append_paths(const EnvironmentLight& light, const FogThere& fog, size_t ray, float weight, float which, vec2 u,
                  vec2 v, std::vector<SkyPath>& paths) {
    const Environment& environment = *light.environment;
    const auto append = [&](vec3 direction, vec3 radiance, float by_light) {
        const auto [share, by_phase] = scattered(light.fog, fog, direction);
        const vec3 arriving = share * radiance * (weight / (by_light + by_phase));
        if (max_component(arriving) > 0) paths.push_back({ray, fog.point, direction, arriving});
    };
    const EnvironmentSample sample = sample_environment(environment, u);
    if (sample.density > 0) append(sample.direction, sample.radiance, sample.density);
    const vec3 direction = direction_by_phase(light.fog, fog, which, v);
    append(direction, environment_radiance(environment, direction), environment_density(environment, direction));
}

// The paths of one ray, up to the end of its fog.
void append_ray(const EnvironmentLight& light, const RayBatch& batch, size_t i, FogPieces& pieces,
                std::vector<SkyPath>& paths) {
    const Ray& ray = batch.rays[i];
    find_fog(ray, light.fog, light.min_transmittance, pieces);
    if (pieces.pieces.empty() || !(pieces.depth > 0)) return;
    const double factor = light.style.view_depth;
    const double seen = factor > 0 ? -std::expm1(-factor * pieces.depth) / factor : pieces.depth;
    const auto points = static_cast<uint32_t>(light.points);
    static thread_local FogThere fog;
    for (uint32_t k = 0; k < points; ++k) {
        const vec2 u = point_numbers(batch, i, k, points, use_place);
        const double depth = factor > 0 ? -std::log1p(-factor * double(u.x) * seen) / factor : u.x * seen;
        size_t piece = 0;
        const double t = distance_at(pieces, depth, piece);
        if (!(look_at_fog(pieces, piece, ray, t, fog) > 0)) continue;
        const float fade = fades(light.style) ? style_fade(light.style, eye_distance(light.camera, fog.point)) : 1;
        const float weight = static_cast<float>(seen) * fade * light.environment->volume_scale / float(points);
        append_paths(light, fog, i, weight, u.y, point_numbers(batch, i, k, points, use_light),
                     point_numbers(batch, i, k, points, use_phase), paths);
    }
}

// Share of the light of up to 16 paths that surfaces let through.
void see_sky(const Occluders& occluders, std::span<const SkyPath> paths, float* shares) {
    Occluders::ShadowRays rays{};
    for (size_t i = 0; i < paths.size(); ++i) rays.set(i, {paths[i].point, paths[i].direction, infinity});
    occluders.transmission(rays, shares);
}
}

EnvironmentLight environment_light(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms,
                                   const Camera& camera, bool shadows, float min_transmittance) {
    EnvironmentLight light;
    light.environment = snapshot.environment;
    if (!light.environment) return light;
    if (shadows && light.environment->shadows && snapshot.occluders && !snapshot.occluders->empty())
        light.occluders = snapshot.occluders;
    for (const Medium& medium : snapshot.media)
        if (!only_emits(medium.optics)) light.fog.push_back(medium);
    light.style = style, light.camera = camera, light.points = terms.light_points;
    light.light_depth = terms.light == LightTransmittance::off ? 0 : style.light_depth;
    light.min_transmittance = min_transmittance;
    return light;
}

void add_environment_light(const EnvironmentLight& light, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local FogPieces pieces;
    static thread_local std::vector<SkyPath> paths;
    paths.clear();
    for (size_t i = 0; i < batch.rays.size(); ++i) append_ray(light, batch, i, pieces, paths);
    for (size_t first = 0; first < paths.size(); first += 16) {
        const std::span<const SkyPath> some =
            std::span(paths).subspan(first, std::min<size_t>(16, paths.size() - first));
        alignas(64) float shares[16];
        std::fill_n(shares, 16, 1.0f);
        if (light.occluders) see_sky(*light.occluders, some, shares);
        for (size_t i = 0; i < some.size(); ++i) {
            const SkyPath& path = some[i];
            ++results[path.ray].steps;
            if (!(shares[i] > 0)) continue;
            const double depth =
                light.light_depth > 0
                    ? light.light_depth * optical_depth(light.fog, {path.point, path.direction, infinity})
                    : 0;
            const vec3 added = path.light * (shares[i] * static_cast<float>(std::exp(-depth)));
            results[path.ray].radiance += added;
            if (!batch.parts.empty()) batch.part(path.ray, batch.index_of(OtherLight::ambient)) += added;
        }
    }
}

ScatterFunction with_environment_light(EnvironmentLight light, ScatterFunction scatter) {
    if (!light.environment || light.fog.empty()) return scatter;
    return [light = std::make_shared<const EnvironmentLight>(std::move(light)),
            scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        scatter(batch, results);
        add_environment_light(*light, batch, results);
    };
}
}

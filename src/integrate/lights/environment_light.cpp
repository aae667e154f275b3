#include "integrate/lights/environment_light.h"

#include "integrate/lights/fog_points.h"
#include "integrate/terms.h"
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

namespace tyndall {
namespace {
enum Use : uint32_t { use_place = 0x5f1e, use_light, use_phase };

// Both directions from one point; `weight`: of what is scattered there.
void append_paths(const EnvironmentLight& light, const FogThere& there, size_t ray, float weight, float which, vec2 u,
                  vec2 v, std::vector<ScatterPath>& paths) {
    const Environment& environment = *light.environment;
    const auto append = [&](vec3 direction, vec3 radiance, float by_light) {
        const auto [share, by_phase] = scattered(light.fog.media, there, direction);
        const vec3 arriving = share * radiance * (weight / (by_light + by_phase));
        if (max_component(arriving) > 0) paths.push_back({ray, {there.point, direction, infinity}, arriving});
    };
    const EnvironmentSample sample = sample_environment(environment, u);
    if (sample.density > 0) append(sample.direction, sample.radiance, sample.density);
    const vec3 direction = direction_by_phase(light.fog.media, there, which, v);
    append(direction, environment_radiance(environment, direction), environment_density(environment, direction));
}

// The paths of one ray, up to the end of its fog.
void append_ray(const EnvironmentLight& light, const RayBatch& batch, size_t i, FogPieces& pieces,
                std::vector<ScatterPath>& paths) {
    const Ray& ray = batch.rays[i];
    find_fog(ray, light.fog.media, light.fog.min_transmittance, pieces);
    if (pieces.pieces.empty() || !(pieces.depth > 0)) return;
    const SeenFog seen = seen_fog(pieces, light.fog.style.view_depth);
    const auto points = static_cast<uint32_t>(light.fog.points);
    static thread_local FogThere there;
    for (uint32_t k = 0; k < points; ++k) {
        const vec2 u = point_numbers(batch, i, k, points, use_place);
        size_t piece = 0;
        const double t = seen.distance(double(u.x), piece);
        if (!(look_at_fog(pieces, piece, ray, t, there) > 0)) continue;
        const float weight = static_cast<float>(seen.whole) * shown_share(light.fog, there.point) *
                             light.environment->volume_scale / float(points);
        append_paths(light, there, i, weight, u.y, point_numbers(batch, i, k, points, use_light),
                     point_numbers(batch, i, k, points, use_phase), paths);
    }
}
}

EnvironmentLight environment_light(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms,
                                   const Camera& camera, bool shadows, float min_transmittance) {
    EnvironmentLight light;
    light.environment = snapshot.environment;
    if (!light.environment) return light;
    if (shadows && light.environment->shadows && snapshot.occluders && !snapshot.occluders->empty())
        light.occluders = snapshot.occluders;
    light.fog = scattering_fog(snapshot, style, terms, camera, min_transmittance);
    return light;
}

void add_environment_light(const EnvironmentLight& light, const RayBatch& batch, std::span<Scatter> results) {
    static thread_local FogPieces pieces;
    static thread_local std::vector<ScatterPath> paths;
    paths.clear();
    for (size_t i = 0; i < batch.rays.size(); ++i) append_ray(light, batch, i, pieces, paths);
    add_scatter_paths(light.fog, light.occluders.get(), paths,
                      batch.parts.empty() ? 0 : batch.index_of(OtherLight::ambient), batch, results);
}

ScatterFunction with_environment_light(EnvironmentLight light, ScatterFunction scatter) {
    if (!light.environment || !scatters(light.fog)) return scatter;
    return [light = std::make_shared<const EnvironmentLight>(std::move(light)),
            scatter = std::move(scatter)](const RayBatch& batch, std::span<Scatter> results) {
        scatter(batch, results);
        add_environment_light(*light, batch, results);
    };
}
}

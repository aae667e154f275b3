// Single scattering of environment light. Distances are sampled in proportion to extinction times transmittance to the
// eye; directions by multiple importance sampling (balance heuristic) of the environment and the phase function.
#include "integrate/lights/path_lights.h"

#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

namespace tyndall {
namespace {
enum Use : uint32_t { use_place = 0x5f1e, use_light, use_phase };

// Appends one path by each strategy from one point; `weight` scales the scattered light.
void append_paths(const Environment& environment, const ScatteringFog& fog, const FogSample& there, size_t ray,
                  float weight, float which, vec2 u, vec2 v, std::vector<ScatterPath>& paths) {
    const auto append = [&](vec3 direction, vec3 radiance, float by_light) {
        const auto [share, by_phase] = scattered(fog.media, there, direction);
        const vec3 arriving = share * radiance * (weight / (by_light + by_phase));
        if (max_component(arriving) > 0) paths.push_back({ray, {there.point, direction, infinity}, arriving});
    };
    const EnvironmentSample sample = sample_environment(environment, u);
    if (sample.pdf > 0) append(sample.direction, sample.radiance, sample.pdf);
    const vec3 direction = direction_by_phase(fog.media, there, which, v);
    append(direction, environment_radiance(environment, direction), environment_pdf(environment, direction));
}

void append_ray(const Environment& environment, const ScatteringFog& fog, const RayBatch& batch, size_t i,
                const FogSampler& seen, std::vector<ScatterPath>& paths) {
    const auto points = static_cast<uint32_t>(fog.points);
    static thread_local FogSample there;
    for (uint32_t k = 0; k < points; ++k) {
        const vec2 u = point_numbers(batch, i, k, points, use_place);
        size_t piece = 0;
        const double t = seen.distance(double(u.x), piece);
        if (!(evaluate_fog(seen.pieces, piece, batch.rays[i], t, there) > 0)) continue;
        const float weight =
            static_cast<float>(seen.whole) * fade_at(fog, there.point) * environment.volume_scale / float(points);
        append_paths(environment, fog, there, i, weight, u.y, point_numbers(batch, i, k, points, use_light),
                     point_numbers(batch, i, k, points, use_phase), paths);
    }
}
}

void append_environment_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                              std::vector<PathLight>& lights) {
    if (!snapshot.environment) return;
    lights.push_back({shadows ? shadow_casters(*snapshot.environment, snapshot) : nullptr, OtherLight::ambient,
                      [environment = snapshot.environment, fog = std::move(fog)](
                          const RayBatch& batch, size_t i, const FogSampler& seen, std::vector<ScatterPath>& paths) {
                          append_ray(*environment, *fog, batch, i, seen, paths);
                      }});
}
}

// Single scattering of light from rectangles, discs and spheres. Distances are sampled both equi-angularly and in
// proportion to extinction times transmittance to the eye; directions both by solid angle of the light and by the phase
// function. Combined by multiple importance sampling (balance heuristic).
#include "integrate/lights/path_lights.h"

#include "scene/lights/area_shape.h"
#include "scene/lights/light_reach.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
namespace {
enum Use : uint32_t { use_distance = 0x7fac, use_point, use_phase, use_medium };

constexpr int pairs_for_a_point = 2; // of distances: one equi-angular, one by the fog

// The two distance sampling strategies on a ray for one light.
struct Distances {
    const FogSampler& fog;
    EquiAngularSampler angles;
};

// True if the phase function's lobe at a point is narrower than the solid angle of the light: only then is phase
// function sampling worthwhile.
bool is_wide(const ScatteringFog& fog, const FogSample& there, const Light& light) {
    const vec3 offset = there.point - light.position;
    float peak = 0;
    for (size_t m = 0; m < fog.peaks.size(); ++m) peak += there.shares[m] * fog.peaks[m];
    return peak * face_area(*light.area) > glm::dot(offset, offset);
}

// Random numbers for sampling directions.
struct DirectionNumbers {
    vec2 face, phase;
    float medium = 0;
};

// Appends up to two paths to the light from the point at distance t, one of `count` distances.
void append_paths(const ScatteringFog& fog, const Light& light, const Ray& ray, const Distances& distances, double t,
                  size_t piece, double count, const DirectionNumbers& u, size_t number,
                  std::vector<ScatterPath>& paths) {
    static thread_local FogSample there;
    const double extinction = evaluate_fog(distances.fog.pieces, piece, ray, t, there);
    if (!(extinction > 0)) return;
    const double transmittance = distances.fog.transmittance(piece, t);
    const double pdf = count * (distances.angles.pdf(t) + distances.fog.pdf(extinction, transmittance));
    if (!(pdf > 0)) return;
    const double weight = extinction * transmittance / pdf * (fade_at(fog, there.point) * light.volume_scale);
    const bool wide = is_wide(fog, there, light);
    const auto append = [&](vec3 direction, float distance, float steradians) {
        const auto [share, by_phase] = scattered(fog.media, there, direction);
        const vec3 picture = face_texture(*light.area, there.point + distance * direction);
        const vec3 arriving =
            share * radiance_of(light) * picture *
            static_cast<float>(weight * steradians / (1 + (wide ? double{steradians} * by_phase : 0)));
        if (max_component(arriving) > 0)
            paths.push_back({number, {there.point, direction, distance * shadow_reach<float>}, arriving});
    };
    const AreaSample sample = sample_area(*light.area, there.point, u.face);
    if (sample.steradians > 0) append(sample.direction, sample.distance, sample.steradians);
    if (!wide) return;
    const vec3 direction = direction_by_phase(fog.media, there, u.medium, u.phase);
    const float distance = area_hit(*light.area, {there.point, direction, infinity});
    if (distance < infinity)
        append(direction, distance, area_steradians(*light.area, there.point, direction, distance));
}

void append_ray(const ScatteringFog& fog, const Light& light, size_t number, const RayBatch& batch, size_t i,
                const FogSampler& seen, std::vector<ScatterPath>& paths) {
    const Ray& ray = batch.rays[i];
    const FogPieces& pieces = seen.pieces;
    // Restrict sampling to the range of the light.
    const Interval<double> reach = light_reach(light, dvec3(ray.origin), dvec3(ray.direction));
    const Distances distances{
        seen, equi_angular_sampler(ray, pieces, dvec3(light.position), double{capped_radius(light)}, reach)};
    if (distances.angles.empty()) return;
    const auto pairs = static_cast<uint32_t>(fog.points * pairs_for_a_point);
    const auto use = static_cast<uint32_t>(4 * number) * 0x9e37u;
    for (uint32_t k = 0; k < pairs; ++k) {
        const auto append = [&](double t, size_t piece, uint32_t point) {
            const auto numbers = [&](Use what) { return point_numbers(batch, i, point, 2 * pairs, what + use); };
            append_paths(fog, light, ray, distances, t, piece, pairs,
                         {numbers(use_point), numbers(use_phase), numbers(use_medium).x}, i, paths);
        };
        const vec2 u = point_numbers(batch, i, k, pairs, use_distance + use);
        const double by_angle = distances.angles.angles.at(u.x).t;
        if (const size_t piece = piece_at(pieces, by_angle); piece < pieces.pieces.size())
            append(by_angle, piece, 2 * k);
        size_t piece = 0;
        const double by_fog = distances.fog.distance(double{u.y}, piece);
        append(by_fog, piece, 2 * k + 1);
    }
}
}

void take_area_lights(Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                      std::vector<PathLight>& lights) {
    const auto first = std::ranges::find_if(snapshot.lights, [](const Light& light) { return light.area != nullptr; });
    const auto before = static_cast<size_t>(first - snapshot.lights.begin());
    const std::vector<Light> faces(first, snapshot.lights.end());
    snapshot.lights.erase(first, snapshot.lights.end());
    for (size_t number = 0; number < faces.size(); ++number) {
        if (!(faces[number].volume_scale > 0)) continue;
        lights.push_back({shadows ? shadow_casters(faces[number], snapshot) : nullptr, before + number,
                          [light = faces[number], number, fog](const RayBatch& batch, size_t i, const FogSampler& seen,
                                                               std::vector<ScatterPath>& paths) {
                              append_ray(*fog, light, number, batch, i, seen, paths);
                          }});
    }
}
}

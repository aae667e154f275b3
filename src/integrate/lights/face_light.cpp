// Light of rectangles, discs and balls that fog scatters once towards the eye. Distances are picked both evenly in the
// angle around the light and in proportion to what would be seen from there, which share it (balance heuristic); points
// of the face by its solid angle.
#include "integrate/lights/path_lights.h"

#include "scene/area_shape.h"
#include "scene/light_reach.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
namespace {
enum Use : uint32_t { use_distance = 0x7fac, use_point = 0x7fad };

constexpr int pairs_for_a_point = 2; // of distances, one by angle and one by fog

// The two ways to pick distances on a ray, for one light.
struct Distances {
    const SeenFog& fog;
    AngleDistances angles;
};

// A way from a distance of the ray to a point of the light, one of `count`.
void append_path(const ScatteringFog& fog, const Light& light, const Ray& ray, const Distances& distances, double t,
                 size_t piece, double count, vec2 u, size_t number, std::vector<ScatterPath>& paths) {
    static thread_local FogThere there;
    const double extinction = look_at_fog(distances.fog.pieces, piece, ray, t, there);
    if (!(extinction > 0)) return;
    const double passing = distances.fog.passing(piece, t);
    const double density = count * (distances.angles.density(t) + distances.fog.density(extinction, passing));
    const AreaSample sample = sample_area(*light.area, there.point, u);
    if (!(density > 0) || !(sample.steradians > 0)) return;
    const double weight =
        extinction * passing / density * (sample.steradians * shown_share(fog, there.point) * light.volume_scale);
    const vec3 share = scattered(fog.media, there, sample.direction).first;
    const vec3 picture = face_picture(*light.area, there.point + sample.distance * sample.direction);
    const ScatterPath path{number,
                           {there.point, sample.direction, sample.distance * 0.9999f},
                           share * radiance_of(light) * static_cast<float>(weight) * picture};
    if (max_component(path.light) > 0) paths.push_back(path);
}

void append_ray(const ScatteringFog& fog, const Light& light, size_t number, const RayBatch& batch, size_t i,
                const SeenFog& seen, std::vector<ScatterPath>& paths) {
    const Ray& ray = batch.rays[i];
    const FogPieces& pieces = seen.pieces;
    // Only what the light reaches is worth asking for.
    const Interval<double> reach = light_reach(light, dvec3(ray.origin), dvec3(ray.direction));
    const Distances distances{seen,
                              angle_distances(ray, pieces, dvec3(light.position), double{capped_radius(light)}, reach)};
    if (distances.angles.empty()) return;
    const auto pairs = static_cast<uint32_t>(fog.points * pairs_for_a_point);
    const auto use = static_cast<uint32_t>(2 * number) * 0x9e37u;
    for (uint32_t k = 0; k < pairs; ++k) {
        const auto append = [&](double t, size_t piece, uint32_t point) {
            append_path(fog, light, ray, distances, t, piece, pairs,
                        point_numbers(batch, i, point, 2 * pairs, use_point + use), i, paths);
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

void take_faces(Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                std::vector<PathLight>& lights) {
    const auto first = std::ranges::find_if(snapshot.lights, [](const Light& light) { return light.area != nullptr; });
    const auto before = static_cast<size_t>(first - snapshot.lights.begin());
    const std::vector<Light> faces(first, snapshot.lights.end());
    snapshot.lights.erase(first, snapshot.lights.end());
    for (size_t number = 0; number < faces.size(); ++number) {
        if (!(faces[number].volume_scale > 0)) continue;
        lights.push_back({shadows ? shadow_casters(faces[number], snapshot) : nullptr, before + number,
                          [light = faces[number], number, fog](const RayBatch& batch, size_t i, const SeenFog& seen,
                                                               std::vector<ScatterPath>& paths) {
                              append_ray(*fog, light, number, batch, i, seen, paths);
                          }});
    }
}
}

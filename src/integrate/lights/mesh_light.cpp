// Single scattering of light from emissive surfaces. Surface points are sampled by power; distances both equi-angularly
// around such a point and in proportion to extinction times transmittance to the eye, combined by multiple importance
// sampling (balance heuristic).
#include "integrate/lights/path_lights.h"

#include "scene/light.h"
#include "trace/lights/emissive_triangles.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

namespace tyndall {
namespace {
enum Use : uint32_t { use_distance = 0x4e54, use_triangle, use_place };

constexpr double closest_share = 1e-5; // minimum equi-angular height, relative to the ray's length in fog

// Emissive triangles, and the surfaces they belong to. Only light shadowed by one set of casters counts.
struct GlowingSurfaces {
    std::shared_ptr<const EmissiveTriangles> triangles;
    std::shared_ptr<const Occluders> occluders;
    std::vector<ivec2> links; // as in Snapshot
    int casters = -1;

    bool counts(const EmissivePoint& target) const {
        return links.empty() || links[static_cast<size_t>(target.instance)].x == casters;
    }
};

EmissivePoint pick_point(const GlowingSurfaces& light, const RayBatch& batch, size_t i, uint32_t k, uint32_t count) {
    return sample_triangles(*light.triangles, *light.occluders, point_numbers(batch, i, k, count, use_triangle).x,
                            point_numbers(batch, i, k, count, use_place));
}

// Appends one of `count` pairs of paths: from the point at distance t to a point on an emissive surface.
void append_path(const ScatteringFog& fog, const Ray& ray, const FogSampler& seen, const EquiAngularSampler& angles,
                 double t, size_t piece, double count, const EmissivePoint& target, size_t number,
                 std::vector<ScatterPath>& paths) {
    static thread_local FogSample there;
    const double extinction = evaluate_fog(seen.pieces, piece, ray, t, there);
    const vec3 offset = target.position - there.point;
    const float away = glm::length(offset);
    if (!(extinction > 0) || !(away > 0)) return;
    const double transmittance = seen.transmittance(piece, t);
    const double pdf = count * (angles.pdf(t) + seen.pdf(extinction, transmittance)) * double{target.pdf} * away * away;
    if (!(pdf > 0)) return;
    const vec3 direction = offset / away;
    const double weight =
        extinction * transmittance * std::abs(glm::dot(target.normal, direction)) * fade_at(fog, there.point) / pdf;
    const vec3 light = scattered(fog.media, there, direction).first * target.emission * fog.style.tint;
    const ScatterPath path{
        number, {there.point, direction, away * shadow_reach<float>}, light * static_cast<float>(weight)};
    if (max_component(path.light) > 0) paths.push_back(path);
}

void append_ray(const GlowingSurfaces& light, const ScatteringFog& fog, const RayBatch& batch, size_t i,
                const FogSampler& seen, std::vector<ScatterPath>& paths) {
    const Ray& ray = batch.rays[i];
    const FogPieces& pieces = seen.pieces;
    const double min_height = closest_share * (pieces.pieces.back().high - pieces.pieces.front().low);
    const auto pairs = static_cast<uint32_t>(fog.points); // of distances: one equi-angular, one by the fog
    for (uint32_t k = 0; k < pairs; ++k) {
        const vec2 u = point_numbers(batch, i, k, pairs, use_distance);
        const auto append = [&](bool by_angle, uint32_t point) {
            const EmissivePoint target = pick_point(light, batch, i, point, 2 * pairs);
            if (!light.counts(target)) return;
            const EquiAngularSampler angles = equi_angular_sampler(ray, pieces, dvec3(target.position), min_height);
            if (by_angle && angles.empty()) return;
            size_t piece = 0;
            const double t = by_angle ? angles.angles.at(u.x).t : seen.distance(double{u.y}, piece);
            if (by_angle) piece = piece_at(pieces, t);
            if (piece < pieces.pieces.size()) append_path(fog, ray, seen, angles, t, piece, pairs, target, i, paths);
        };
        append(true, 2 * k), append(false, 2 * k + 1);
    }
}
}

void append_mesh_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights) {
    const auto triangles = emissive_triangles(snapshot);
    if (!triangles) return;
    for (const int casters : triangles->casters)
        lights.push_back({shadows ? caster_surfaces(casters, snapshot) : nullptr, OtherLight::emission,
                          [light = GlowingSurfaces{triangles, snapshot.occluders, snapshot.emission_links, casters},
                           fog](const RayBatch& batch, size_t i, const FogSampler& seen,
                                std::vector<ScatterPath>& paths) { append_ray(light, *fog, batch, i, seen, paths); }});
}
}

// Single scattering of light from emission grids. Three strategies sample a point on the ray and a point in the fire,
// combined by multiple importance sampling (balance heuristic): fire points by power with equi-angular distances; fire
// points by power with distances in proportion to extinction times transmittance to the eye; and, from those distances,
// directions by the phase function and fire points by emission along them, which matters inside the fire.
#include "integrate/lights/path_lights.h"

#include "trace/lights/emissive_bricks.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

namespace tyndall {
namespace {
enum Use : uint32_t { use_distance = 0x3f12, use_brick, use_in_brick, use_phase, use_on_line };

constexpr double closest_share = 1e-5; // minimum equi-angular height, relative to the ray's length in fog

// A ray through the fog, with what sampling on it needs.
struct FireRay {
    const EmissiveBricks& fire;
    const ScatteringFog& fog;
    const Ray& ray;
    size_t number;
    const FogSampler& seen;
    double rounds;
    double min_height;
    std::vector<ScatterPath>& paths;

    EquiAngularSampler around(vec3 place) const {
        return equi_angular_sampler(ray, seen.pieces, dvec3(place), min_height);
    }
};

// A scattering point on the ray.
struct FirePoint {
    double distance = 0, extinction = 0, transmittance = 0;
    FogSample there;
};

bool look(const FireRay& fire_ray, double distance, size_t piece, FirePoint& point) {
    point.distance = distance;
    point.extinction = evaluate_fog(fire_ray.seen.pieces, piece, fire_ray.ray, distance, point.there);
    point.transmittance = fire_ray.seen.transmittance(piece, distance);
    return point.extinction > 0 && point.transmittance > 0;
}

// Appends the path from a fire point via a scattering point to the eye, weighted by one over the total PDF of the three
// strategies. The squared distance between the points cancels and is left out, because it may be 0.
void append_path(const FireRay& fire_ray, const FirePoint& point, const EmissionSample& place,
                 const EquiAngularSampler& angles, double share) {
    const FogSample& there = point.there;
    const vec3 offset = place.position - there.point;
    const float away = glm::length(offset);
    if (!(max_component(place.emission) > 0) || !(away > 0)) return;
    const ScatteringFog& fog = fire_ray.fog;
    const auto [albedo, by_phase] = scattered(fog.media, there, offset / away);
    const double by_fog = fire_ray.seen.pdf(point.extinction, point.transmittance);
    const double aimed = double{place.pdf} * away * away;
    const double pdf =
        fire_ray.rounds * (aimed * (angles.pdf(point.distance) + by_fog) + by_fog * by_phase * place.line_pdf);
    const double weight = share * point.extinction * point.transmittance * fade_at(fog, there.point) / pdf;
    if (!(pdf > 0)) return;
    const ScatterPath path{
        fire_ray.number, {there.point, offset / away, away}, albedo * place.emission * static_cast<float>(weight)};
    if (max_component(path.light) > 0) fire_ray.paths.push_back(path);
}

// Samples a direction by the phase function. The actual PDF of the sampled fire point differs from the approximate
// line_pdf in the balance heuristic; the ratio goes into the share.
void append_lines(const FireRay& fire_ray, const FirePoint& point, float which, vec2 u, float v) {
    const vec3 direction = direction_by_phase(fire_ray.fog.media, point.there, which, u);
    for (size_t field = 0; field < fire_ray.fire.fields.size(); ++field) {
        const EmissionOnLine hit = emission_on_line(fire_ray.fire, field, {point.there.point, direction, infinity}, v);
        if (!(hit.inverse_pdf > 0)) continue;
        append_path(fire_ray, point, hit.sample, fire_ray.around(hit.sample.position),
                    double{hit.inverse_pdf} * hit.sample.line_pdf);
    }
}

EmissionSample pick_place(const FireRay& fire_ray, const RayBatch& batch, uint32_t k, uint32_t count) {
    const vec2 first = point_numbers(batch, fire_ray.number, k, count, use_brick),
               second = point_numbers(batch, fire_ray.number, k, count, use_in_brick);
    return sample_emission(fire_ray.fire, first.x, {first.y, second.x, second.y});
}

// Appends one path by each strategy.
void append_round(const FireRay& fire_ray, const RayBatch& batch, uint32_t k) {
    static thread_local FirePoint point;
    const auto rounds = static_cast<uint32_t>(fire_ray.rounds);
    const vec2 u = point_numbers(batch, fire_ray.number, k, rounds, use_distance);
    const EmissionSample first = pick_place(fire_ray, batch, 2 * k, 2 * rounds);
    if (const EquiAngularSampler angles = fire_ray.around(first.position); !angles.empty()) {
        const double t = angles.angles.at(u.x).t;
        const size_t piece = piece_at(fire_ray.seen.pieces, t);
        if (piece < fire_ray.seen.pieces.pieces.size() && look(fire_ray, t, piece, point))
            append_path(fire_ray, point, first, angles, 1);
    }

    size_t piece = 0;
    const double t = fire_ray.seen.distance(double{u.y}, piece);
    if (!look(fire_ray, t, piece, point)) return;
    const EmissionSample second = pick_place(fire_ray, batch, 2 * k + 1, 2 * rounds);
    append_path(fire_ray, point, second, fire_ray.around(second.position), 1);
    const vec2 v = point_numbers(batch, fire_ray.number, k, rounds, use_on_line);
    append_lines(fire_ray, point, v.x, point_numbers(batch, fire_ray.number, k, rounds, use_phase), v.y);
}

void append_ray(const EmissiveBricks& fire, const ScatteringFog& fog, const RayBatch& batch, size_t i,
                const FogSampler& seen, std::vector<ScatterPath>& paths) {
    const std::vector<FogPieces::Piece>& pieces = seen.pieces.pieces;
    const double min_height = closest_share * (pieces.back().high - pieces.front().low);
    const FireRay fire_ray{fire, fog, batch.rays[i], i, seen, double(fog.points), min_height, paths};
    for (int k = 0; k < fog.points; ++k)
        append_round(fire_ray, batch, static_cast<uint32_t>(k)); // one path by each strategy
}
}

void append_fire_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights) {
    std::shared_ptr<const EmissiveBricks> fire = emissive_bricks(snapshot, Emitting::all);
    if (!fire) return;
    const bool shadowed = shadows && snapshot.occluders && !snapshot.occluders->empty();
    lights.push_back({shadowed ? snapshot.occluders : nullptr, OtherLight::emission,
                      [fire = std::move(fire), fog = std::move(fog)](
                          const RayBatch& batch, size_t i, const FogSampler& seen, std::vector<ScatterPath>& paths) {
                          append_ray(*fire, *fog, batch, i, seen, paths);
                      }});
}
}

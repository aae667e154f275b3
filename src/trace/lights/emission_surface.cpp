#include "trace/lights/emission_surface.h"

#include "base/random.h"
#include "scene/light.h"
#include "trace/lights/emissive_bricks.h"
#include "trace/lights/emissive_triangles.h"
#include "trace/lights/surface_rays.h"
#include "trace/snapshot.h"
#include "trace/surface.h"

#include <algorithm>
#include <bit>

namespace tyndall {
namespace {
// `share`: pdf used in the balance heuristic over the actual one; 1 for places picked by power.
void set_place(const SurfacePoint& point, const EmissionSample& place, float share, size_t i, SurfaceRays& to) {
    const vec3 offset = place.position - point.position;
    const float away = glm::length(offset), cosine = away > 0 ? glm::dot(point.normal, offset) / away : 0;
    const float pdf = place.pdf * away * away + cosine / pi * place.line_pdf;
    if (!(cosine > 0) || !(pdf > 0) || !(share > 0)) return;
    to.set(i, point, offset / away, away, point.base_color / pi * place.emission * (cosine * share / pdf));
}

// Further random numbers for a point, seeded by its sample pair.
RandomStream numbers_after(vec2 pair) {
    return {hash(std::bit_cast<uint32_t>(pair.x), std::bit_cast<uint32_t>(pair.y))};
}

void add_fire(const EmissiveBricks& fire, const Snapshot& snapshot, std::span<const SurfacePoint> points,
              std::span<const vec2> pairs, float scale, std::span<vec3> radiance) {
    SurfaceRays picked;
    std::vector<SurfaceRays> on_lines(fire.fields.size());
    for (size_t i = 0; i < points.size(); ++i) {
        const vec2 pair = pairs[i];
        RandomStream random = numbers_after(pair);
        const float x = random.next(), y = random.next(), along = random.next();
        set_place(points[i], sample_emission(fire, pair.x, {pair.y, x, y}), 1, i, picked);
        const vec3 direction = cosine_direction(points[i].normal, glm::fract(pair + vec2(0.618034f, 0.754878f)));
        for (size_t field = 0; field < fire.fields.size(); ++field) {
            const EmissionOnLine hit = emission_on_line(fire, field, {points[i].position, direction, infinity}, along);
            if (hit.inverse_pdf > 0)
                set_place(points[i], hit.sample, hit.inverse_pdf * hit.sample.line_pdf, i, on_lines[field]);
        }
    }
    add_unblocked(picked, snapshot.occluders.get(), snapshot.media, points, scale, radiance);
    for (const SurfaceRays& to : on_lines)
        add_unblocked(to, snapshot.occluders.get(), snapshot.media, points, scale, radiance);
}

// The light of surfaces that the same set of casters shadows.
void add_surfaces(const EmissiveTriangles& emissive, int casters, const Snapshot& snapshot,
                  std::span<const SurfacePoint> points, std::span<const vec2> pairs, float scale,
                  std::span<vec3> radiance) {
    SurfaceRays picked;
    for (size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint& point = points[i];
        const EmissivePoint target =
            sample_triangles(emissive, *snapshot.occluders, numbers_after(pairs[i]).next(), pairs[i]);
        if (emission_links(snapshot, target.instance).x != casters ||
            !is_lit_by_emitter(snapshot, target.instance, point.instance))
            continue;
        const vec3 offset = target.position - point.position;
        const float away = glm::length(offset), cosine = away > 0 ? glm::dot(point.normal, offset) / away : 0;
        if (!(cosine > 0)) continue;
        const vec3 direction = offset / away;
        const float seen = cosine * std::abs(glm::dot(target.normal, direction)) / (target.pdf * away * away);
        picked.set(i, point, direction, away * shadow_reach<float>, point.base_color / pi * target.emission * seen);
    }
    add_unblocked(picked, caster_surfaces(casters, snapshot).get(), snapshot.media, points, scale, radiance);
}
}

Emitters emitters_of(const Snapshot& snapshot) {
    return {emissive_bricks(snapshot, Emitting::all), emissive_triangles(snapshot)};
}

void add_emitted_light(const Emitters& emitters, const Snapshot& snapshot, std::span<const SurfacePoint> points,
                       std::span<const vec2> u, std::span<vec3> radiance) {
    const size_t count = u.size() / points.size();
    const float scale = 1 / static_cast<float>(count);
    std::vector<vec2> pairs(points.size());
    for (size_t k = 0; k < count; ++k) {
        for (size_t i = 0; i < points.size(); ++i) pairs[i] = u[i * count + k];
        if (emitters.fire) add_fire(*emitters.fire, snapshot, points, pairs, scale, radiance);
        if (!emitters.surfaces) continue;
        for (const int casters : emitters.surfaces->casters)
            add_surfaces(*emitters.surfaces, casters, snapshot, points, pairs, scale, radiance);
    }
}
}

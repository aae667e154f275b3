#include "trace/fire_surface.h"

#include "base/random.h"
#include "trace/emissive_bricks.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/surface.h"

#include <algorithm>
#include <bit>

namespace tyndall {
namespace {
// A place of the fire for each point, and what each sends on of its light with nothing in the way.
struct FirePlaces {
    Occluders::ShadowRays rays{};
    vec3 light[16] = {};
};

// `share`: of what is found here, over the chance of both ways that is found here alone.
void set_place(const SurfacePoint& point, const EmissivePlace& place, float share, size_t i, FirePlaces& to) {
    const vec3 offset = place.position - point.position;
    const float away = glm::length(offset), cosine = away > 0 ? glm::dot(point.normal, offset) / away : 0;
    const float chance = place.density * away * away + cosine / pi * place.line_density;
    if (!(cosine > 0) || !(chance > 0) || !(share > 0)) return;
    const vec3 direction = offset / away;
    to.light[i] = point.base_color / pi * place.emission * (cosine * share / chance);
    if (max_component(to.light[i]) > 0)
        to.rays.set(i, {off_surface(point.position, point.face_normal, direction), direction, away});
}

void shine(const Snapshot& snapshot, std::span<const SurfacePoint> points, const FirePlaces& places, float scale,
           std::span<vec3> radiance) {
    alignas(64) float shares[16];
    std::fill_n(shares, 16, 1.0f);
    if (snapshot.occluders && !snapshot.occluders->empty()) snapshot.occluders->transmission(places.rays, shares);
    for (size_t i = 0; i < points.size(); ++i) {
        if (!places.rays.active[i] || !(shares[i] > 0)) continue;
        const vec3 direction(places.rays.dx[i], places.rays.dy[i], places.rays.dz[i]);
        double depth = 0;
        for (const Medium& medium : snapshot.media)
            if (!only_emits(medium.optics))
                depth += optical_depth(medium, {points[i].position, direction, places.rays.t_max[i]});
        radiance[i] += places.light[i] * (scale * shares[i] * static_cast<float>(std::exp(-depth)));
    }
}

// More numbers for the same point and pair.
RandomStream numbers_after(vec2 pair) {
    return {hash(std::bit_cast<uint32_t>(pair.x), std::bit_cast<uint32_t>(pair.y))};
}
}

void add_fire(const EmissiveBricks& fire, const Snapshot& snapshot, std::span<const SurfacePoint> points,
              std::span<const vec2> u, std::span<vec3> radiance) {
    const size_t count = u.size() / points.size();
    const float scale = 1 / static_cast<float>(count);
    for (size_t k = 0; k < count; ++k) {
        FirePlaces picked;
        std::vector<FirePlaces> on_lines(fire.fields.size());
        for (size_t i = 0; i < points.size(); ++i) {
            const vec2 pair = u[i * count + k];
            RandomStream random = numbers_after(pair);
            const float x = random.next(), y = random.next(), along = random.next();
            set_place(points[i], pick_emissive_place(fire, pair.x, {pair.y, x, y}), 1, i, picked);
            const vec3 direction = cosine_direction(points[i].normal, glm::fract(pair + vec2(0.618034f, 0.754878f)));
            for (size_t field = 0; field < fire.fields.size(); ++field) {
                const Ray line{points[i].position, direction, infinity};
                const EmissionOnLine hit = emission_on_line(fire, field, line, along);
                if (hit.inverse_density > 0)
                    set_place(points[i], hit.place, hit.inverse_density * hit.place.line_density, i, on_lines[field]);
            }
        }
        shine(snapshot, points, picked, scale, radiance);
        for (const FirePlaces& places : on_lines) shine(snapshot, points, places, scale, radiance);
    }
}
}

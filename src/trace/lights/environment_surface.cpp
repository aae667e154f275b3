// Environment light on Lambertian surfaces, attenuated by fog.
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/surface.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// A direction for each point, and the unoccluded light reflected from there.
struct SkyDirections {
    vec3 direction[16], light[16];
};

// Radiance reflected from a direction, over the sum of the pdfs (balance heuristic) of sampling it by radiance,
// `pdf` in 1/sr, and by cosine.
vec3 weighted(const SurfacePoint& point, vec3 direction, vec3 radiance, float pdf) {
    const float cosine = std::max(glm::dot(point.normal, direction), 0.0f);
    return pdf + cosine > 0 ? point.base_color * radiance * (cosine / pi / (pdf + cosine / pi)) : vec3(0);
}

void add_visible(const Snapshot& snapshot, std::span<const SurfacePoint> points, const SkyDirections& sky,
                 std::span<vec3> radiance, float scale) {
    Occluders::ShadowRays rays{};
    alignas(64) float visibility[16];
    std::fill_n(visibility, 16, 1.0f);
    for (size_t i = 0; i < points.size(); ++i)
        if (max_component(sky.light[i]) > 0)
            rays.set(i, off_surface(points[i].face_normal, {points[i].position, sky.direction[i], infinity}));
    if (const auto& casters = shadow_casters(*snapshot.environment, snapshot)) casters->transmission(rays, visibility);
    for (size_t i = 0; i < points.size(); ++i) {
        if (!rays.active[i] || !(visibility[i] > 0)) continue;
        double depth = 0;
        for (const Medium& medium : snapshot.media)
            if (!only_emits(medium.optics))
                depth += optical_depth(medium, {points[i].position, sky.direction[i], infinity});
        radiance[i] += sky.light[i] * (scale * visibility[i] * static_cast<float>(std::exp(-depth)));
    }
}
}

void add_environment(const Snapshot& snapshot, std::span<const SurfacePoint> points, std::span<const vec2> u,
                     std::span<vec3> radiance) {
    const Environment& environment = *snapshot.environment;
    const size_t count = u.size() / points.size();
    const float scale = environment.surface_scale / static_cast<float>(count);
    if (!(environment.surface_scale > 0)) return;
    SkyDirections by_light, by_surface;
    for (size_t k = 0; k < count; ++k) {
        for (size_t i = 0; i < points.size(); ++i) {
            by_light.light[i] = by_surface.light[i] = vec3(0);
            if (!is_lit(environment, snapshot, points[i].instance)) continue;
            const vec2 pair = u[i * count + k];
            const EnvironmentSample sample = sample_environment(environment, pair);
            by_light.direction[i] = sample.direction;
            if (sample.pdf > 0) by_light.light[i] = weighted(points[i], sample.direction, sample.radiance, sample.pdf);
            by_surface.direction[i] = cosine_direction(points[i].normal, glm::fract(pair + vec2(0.618034f, 0.754878f)));
            by_surface.light[i] =
                weighted(points[i], by_surface.direction[i], environment_radiance(environment, by_surface.direction[i]),
                         environment_pdf(environment, by_surface.direction[i]));
        }
        add_visible(snapshot, points, by_light, radiance, scale);
        add_visible(snapshot, points, by_surface, radiance, scale);
    }
}
}

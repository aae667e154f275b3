// Environment light on Lambertian surfaces, attenuated by fog.
#include "trace/lights/environment.h"
#include "trace/lights/surface_rays.h"
#include "trace/surface.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Radiance reflected from a direction, over the sum of the pdfs (balance heuristic) of sampling it by radiance,
// `pdf` in 1/sr, and by cosine.
vec3 weighted(const SurfacePoint& point, vec3 direction, vec3 radiance, float pdf) {
    const float cosine = std::max(glm::dot(point.normal, direction), 0.0f);
    return pdf + cosine > 0 ? point.base_color * radiance * (cosine / pi / (pdf + cosine / pi)) : vec3(0);
}
}

void add_environment(const Snapshot& snapshot, std::span<const SurfacePoint> points, std::span<const vec2> u,
                     std::span<vec3> radiance) {
    const Environment& environment = *snapshot.environment;
    const size_t count = u.size() / points.size();
    const float scale = environment.surface_scale / static_cast<float>(count);
    if (!(environment.surface_scale > 0)) return;
    const Occluders* casters = shadow_casters(environment, snapshot).get();
    for (size_t k = 0; k < count; ++k) {
        SurfaceRays by_light, by_surface;
        for (size_t i = 0; i < points.size(); ++i) {
            const SurfacePoint& point = points[i];
            if (!is_lit(environment, snapshot, point.instance)) continue;
            const vec2 pair = u[i * count + k];
            const auto [sky, light, pdf] = sample_environment(environment, pair);
            if (pdf > 0) by_light.set(i, point, sky, infinity, weighted(point, sky, light, pdf));
            const vec3 direction = cosine_direction(point.normal, glm::fract(pair + vec2(0.618034f, 0.754878f)));
            by_surface.set(i, point, direction, infinity,
                           weighted(point, direction, environment_radiance(environment, direction),
                                    environment_pdf(environment, direction)));
        }
        add_unblocked(by_light, casters, snapshot.media, points, scale, radiance);
        add_unblocked(by_surface, casters, snapshot.media, points, scale, radiance);
    }
}
}

#include "trace/lights/surface_rays.h"

#include "volume/medium.h"

namespace tyndall {
void add_unblocked(const SurfaceRays& to, const Occluders* casters, std::span<const Medium> media,
                   std::span<const SurfacePoint> points, float scale, std::span<vec3> sum) {
    alignas(64) float visibility[16];
    std::fill_n(visibility, 16, 1.0f);
    if (casters) casters->transmission(to.rays, visibility);
    for (size_t i = 0; i < points.size(); ++i) {
        if (!to.rays.active[i] || !(visibility[i] > 0)) continue;
        const Ray way{points[i].position, {to.rays.dx[i], to.rays.dy[i], to.rays.dz[i]}, to.rays.t_max[i]};
        double depth = 0;
        for (const Medium& medium : media)
            if (!only_emits(medium.optics)) depth += optical_depth(medium, way);
        sum[i] += to.light[i] * (scale * visibility[i] * static_cast<float>(std::exp(-depth)));
    }
}
}

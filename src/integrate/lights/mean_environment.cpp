#include "integrate/lights/mean_environment.h"

#include "integrate/lights/path_lights.h"
#include "integrate/terms.h"
#include "scene/scene.h"
#include "trace/lights/environment.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/rays/fog_reach.h"

#include <algorithm>
#include <vector>

namespace tyndall {
namespace {
// Environment light scattered by fog, as in a march with 16 light samples per ray.
ScatterFunction scattered_sky(const View& view, const Snapshot& snapshot) {
    TermSettings terms;
    terms.light_points = 16;
    const auto fog = scattering_fog(snapshot, {}, terms, view.camera, 0);
    std::vector<PathLight> lights;
    append_environment_light(snapshot, fog, true, lights);
    return with_path_lights(fog, std::move(lights),
                            [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); });
}

// The same for the environment's mean radiance, unattenuated: opacity of the ray times mean albedo along it.
dvec3 scattered_mean(const Snapshot& snapshot, const Ray& ray) {
    constexpr int points = 16;
    dvec3 scattered(0);
    double dimmed = 0;
    for (int i = 0; i < points; ++i)
        for (const Medium& medium : snapshot.media) {
            const vec3 point = ray.at(ray.t_max * (static_cast<float>(i) + 0.5f) / points);
            const double extinction = double(density_at(medium, point)) * gray_extinction(medium.optics);
            scattered += extinction * dvec3(albedo_at(medium.optics, point)), dimmed += extinction;
        }
    if (!(dimmed > 0)) return dvec3(0);
    const double opacity = -std::expm1(-optical_depth(snapshot.media, ray));
    return scattered / dimmed * opacity * dvec3(snapshot.environment->mean()) *
           double{snapshot.environment->volume_scale};
}

// Those of a grid of camera rays, up to the first surface, that meet scattering fog.
std::vector<Ray> rays_in_fog(const View& view, const Snapshot& snapshot, uint32_t across, uint32_t down) {
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < across * down; ++i) {
        const vec2 at = (vec2(i % across, i / across) + 0.5f) / vec2(across, down);
        Ray ray = camera_ray(view.camera, view.size, at * vec2(view.size));
        ray.t_max = std::min(fog_reach(snapshot.media, ray), view.camera.far);
        Hits hits;
        if (snapshot.occluders)
            snapshot.occluders->closest({&ray, 1}, 0, hits), ray.t_max = std::min(ray.t_max, hits.t[0]);
        if (ray.t_max > 0 && optical_depth(snapshot.media, ray) > 0) rays.push_back(ray);
    }
    return rays;
}
}

double mean_environment_error(const View& view, const Snapshot& snapshot) {
    constexpr size_t enough = 12;
    uint32_t across = 8, down = 6;
    std::vector<Ray> rays = rays_in_fog(view, snapshot, across, down);
    for (; rays.size() < enough && across < 128; rays = rays_in_fog(view, snapshot, across, down))
        across *= 2, down *= 2;
    const ScatterFunction exact = scattered_sky(view, snapshot);
    double squares = 0, sum = 0;
    for (uint32_t i = 0; i < rays.size(); ++i) {
        Scatter found;
        exact({.rays = {&rays[i], 1}, .ids = {&i, 1}}, {&found, 1});
        const dvec3 off = scattered_mean(snapshot, rays[i]) - dvec3(found.radiance);
        squares += glm::dot(off, off), sum += found.radiance.x + found.radiance.y + found.radiance.z;
    }
    return sum > 0 ? std::sqrt(3 * squares * across * down) / sum : 0;
}
}

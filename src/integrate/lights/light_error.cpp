#include "integrate/lights/light_error.h"

#include "base/random.h"
#include "integrate/lights/path_lights.h"
#include "integrate/terms.h"
#include "scene/light.h"
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

constexpr uint32_t points_of_ray = 64;

// Light that fog scatters per meter into the end of a ray, as its start sees it.
dvec3 scattered_at(const Snapshot& snapshot, const Ray& ray, const LightSample& light) {
    dvec3 scattered(0);
    const vec3 point = ray.at(ray.t_max);
    for (const Medium& medium : snapshot.media)
        if (const float density = density_at(medium, point); density > 0 && !only_emits(medium.optics)) {
            const float phase = phase_value(medium.optics.phase, glm::dot(ray.direction, light.to_light));
            scattered += dvec3(density * medium.optics.extinction * phase * albedo_at(medium.optics, point));
        }
    return max_component(vec3(scattered)) > 0
               ? scattered * dvec3(light.irradiance) * std::exp(-optical_depth(snapshot.media, ray))
               : scattered;
}

// A part of the image, in pixels.
struct ImagePart {
    vec2 low{0}, high{0};
    double share = 1; // of the image's area
};

// The part that shows bounded fog; all of it where fog is unbounded or around the camera.
ImagePart part_with_fog(const View& view, const Snapshot& snapshot) {
    const vec2 size(view.size);
    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    ImagePart part{size, vec2(0)};
    for (int i = 0; i < 8; ++i) {
        const auto at = is_finite(fog.size()) ? pixel_of(view.camera, view.size, fog.corner(i)) : std::nullopt;
        if (!at) return {vec2(0), size};
        part.low = glm::min(part.low, *at), part.high = glm::max(part.high, *at);
    }
    part.low = glm::clamp(part.low, vec2(0), size), part.high = glm::clamp(part.high, part.low, size);
    const vec2 covered = (part.high - part.low) / size;
    part.share = double{covered.x} * covered.y;
    return part;
}

// Those of a grid of camera rays over a part of the image, up to the first surface, that meet scattering fog.
std::vector<Ray> rays_in_fog(const View& view, const Snapshot& snapshot, const ImagePart& part, uint32_t across,
                             uint32_t down) {
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < across * down; ++i) {
        const vec2 at = (vec2(i % across, i / across) + 0.5f) / vec2(across, down);
        Ray ray = camera_ray(view.camera, view.size, glm::mix(part.low, part.high, at));
        ray.t_max = std::min(fog_reach(snapshot.media, ray), view.camera.far);
        Hits hits;
        if (snapshot.occluders)
            snapshot.occluders->closest({&ray, 1}, 0, hits), ray.t_max = std::min(ray.t_max, hits.t[0]);
        if (ray.t_max > 0 && optical_depth(snapshot.media, ray) > 0) rays.push_back(ray);
    }
    return rays;
}
}

double fog_light_error(const View& view, const Snapshot& snapshot,
                       const std::function<RayLight(const Ray& ray, uint32_t i)>& light) {
    constexpr size_t enough = 12;
    const ImagePart part = part_with_fog(view, snapshot);
    if (!(part.share > 0)) return 0;
    uint32_t across = 8, down = 6;
    std::vector<Ray> rays = rays_in_fog(view, snapshot, part, across, down);
    for (; rays.size() < enough && across < 128; rays = rays_in_fog(view, snapshot, part, across, down))
        across *= 2, down *= 2;
    double squares = 0, sum = 0;
    for (uint32_t i = 0; i < rays.size(); ++i) {
        const auto [exact, approximate] = light(rays[i], i);
        const dvec3 off = approximate - exact;
        squares += glm::dot(off, off), sum += exact.x + exact.y + exact.z;
    }
    return squares > 0 ? std::sqrt(3 * squares * across * down / part.share) / sum : 0;
}

double mean_environment_error(const View& view, const Snapshot& snapshot) {
    const ScatterFunction exact = scattered_sky(view, snapshot);
    return fog_light_error(view, snapshot, [&](const Ray& ray, uint32_t i) {
        Scatter found;
        exact({.rays = {&ray, 1}, .ids = {&i, 1}}, {&found, 1});
        return RayLight{dvec3(found.radiance), scattered_mean(snapshot, ray)};
    });
}

double shadow_error(const View& view, const Snapshot& snapshot, const Light& light) {
    const auto& casters = shadow_casters(light, snapshot);
    if (!casters) return 0;
    return fog_light_error(view, snapshot, [&](const Ray& ray, uint32_t i) {
        RayLight sum;
        for (uint32_t k = 0; k < points_of_ray; ++k) {
            const float t = ray.t_max * (static_cast<float>(k) + to_unit(hash(i, k))) / points_of_ray;
            const LightSample at = arrival(light, ray.at(t));
            if (max_component(at.irradiance) <= 0) continue;
            const dvec3 scattered = scattered_at(snapshot, {ray.origin, ray.direction, t}, at);
            if (max_component(vec3(scattered)) <= 0) continue;
            const Ray shadow{ray.at(t), at.to_light, at.distance};
            sum.approximate += scattered, sum.exact += double{casters->transmission(shadow, 0)} * scattered;
        }
        return sum;
    });
}
}

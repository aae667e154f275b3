// Shadows at sixteen points by rays toward a light (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_SHADOW_RAYS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SHADOW_RAYS_SIMD_H
#undef TYNDALL_INTEGRATE_SHADOW_RAYS_SIMD_H
#else
#define TYNDALL_INTEGRATE_SHADOW_RAYS_SIMD_H
#endif

#include "base/random.h"
#include "base/simd/simd.h"
#include "trace/lights/light_ray.h"
#include "trace/lights/light_simd.h"
#include "trace/occlusion/occluders.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Sets up shadow rays from points to a light's center.
HWY_INLINE void aim_at_center(const Vec3s& position, const LightSamples& light_at, const Mask16& wanted,
                              Occluders::ShadowRays& rays) {
    store(position.x, rays.ox), store(position.y, rays.oy), store(position.z, rays.oz);
    store(light_at.to_light.x, rays.dx), store(light_at.to_light.y, rays.dy), store(light_at.to_light.z, rays.dz);
    store(light_at.distance * shadow_reach<float>, rays.t_max);
    alignas(64) float is_wanted[16];
    store(select(wanted, 1.0f, 0.0f), is_wanted);
    for (size_t lane = 0; lane < 16; ++lane) rays.active[lane] = is_wanted[lane] > 0 ? -1 : 0, rays.t_min[lane] = 0;
}

// Redirects the ray of a lane to the point on a soft light selected by u.
inline void aim_at_point(const Light& light, vec2 u, size_t lane, Occluders::ShadowRays& rays) {
    const Ray ray = ray_to_light(light, vec3(rays.ox[lane], rays.oy[lane], rays.oz[lane]), u);
    rays.dx[lane] = ray.direction.x, rays.dy[lane] = ray.direction.y, rays.dz[lane] = ray.direction.z;
    rays.t_max[lane] = ray.t_max;
}

// Redirects the shadow rays to the k-th random points on a soft light. key(lane) is the random seed of a lane.
template<class Key> void aim_at_points(const Light& light, uint32_t k, const Key& key, Occluders::ShadowRays& rays) {
    for (size_t lane = 0; lane < 16; ++lane) {
        if (!rays.active[lane]) continue;
        const uint32_t own = k > 0 ? hash(key(lane), k) : key(lane);
        aim_at_point(light, {to_unit(hash(own, 0u)), to_unit(hash(own, 1u))}, lane, rays);
    }
}

// Transmission of surfaces between a light and the wanted points, by one packet of shadow rays, or for a soft light by
// the mean over `points` packets.
template<class Key>
Floats traced_visibility(const Occluders& occluders, const Light& light, const Vec3s& position,
                         const LightSamples& light_at, const Mask16& wanted, int points, const Key& key) {
    Occluders::ShadowRays rays;
    alignas(64) float share[16] = {};
    aim_at_center(position, light_at, wanted, rays);
    if (!is_soft(light)) {
        occluders.transmission(rays, share);
        return load(share);
    }
    Floats total = 0.0f;
    for (int k = 0; k < points; ++k) {
        aim_at_points(light, static_cast<uint32_t>(k), key, rays);
        occluders.transmission(rays, share);
        total = total + load(share);
    }
    return total * (1 / static_cast<float>(points));
}
}
}
HWY_AFTER_NAMESPACE();
#endif

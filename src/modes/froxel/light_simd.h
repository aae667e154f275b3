// A light as sixteen froxels see it (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_LIGHT_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_LIGHT_SIMD_H
#undef TYNDALL_MODES_FROXEL_LIGHT_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_LIGHT_SIMD_H
#endif

#include "base/random.h"
#include "base/simd/simd.h"
#include "trace/light_simd.h"
#include "trace/transmittance/light_depth_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Sixteen froxels of one slice: where light is asked for, and the stretch of a camera ray that each stands for.
struct FroxelLanes {
    Vec3s point, step;   // in front of every surface; along the line, per metre of planar depth
    Floats z;            // planar depth of the point
    Vec3s start, toward; // of the stretch; unit direction
    Floats length;       // of the stretch, metres
    Floats width2;       // squared radius of the disc as large as the froxel is across
    Mask16 active;
};

// Share of the light that passes the surfaces on the way to each lane's point, one shadow ray each. `places` pick
// points of a soft light; null = its centre.
HWY_INLINE Floats visible_at_points(const Occluders& occluders, const Light& light, const FroxelLanes& lanes,
                                    const Arriving& arrival, const Mask16& wanted, const Sample2* places) {
    Occluders::ShadowRays rays;
    store(lanes.point.x, rays.ox), store(lanes.point.y, rays.oy), store(lanes.point.z, rays.oz);
    store(arrival.to_light.x, rays.dx), store(arrival.to_light.y, rays.dy), store(arrival.to_light.z, rays.dz);
    store(arrival.distance * 0.9999f, rays.t_max);
    alignas(64) float is_wanted[16], share[16] = {};
    store(select(wanted, 1.0f, 0.0f), is_wanted);
    for (size_t i = 0; i < 16; ++i) {
        rays.active[i] = is_wanted[i] > 0 ? -1 : 0, rays.t_min[i] = 0;
        if (!rays.active[i] || !places) continue;
        const vec3 point(rays.ox[i], rays.oy[i], rays.oz[i]);
        const Ray ray = ray_to_light(light, point, vec2(places[i].x, places[i].y));
        rays.dx[i] = ray.direction.x, rays.dy[i] = ray.direction.y, rays.dz[i] = ray.direction.z;
        rays.t_max[i] = ray.t_max;
    }
    occluders.transmission(rays, share);
    return load(share);
}
}
HWY_AFTER_NAMESPACE();
#endif

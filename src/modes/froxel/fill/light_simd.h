// A light as sixteen froxels see it (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_FILL_LIGHT_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_FILL_LIGHT_SIMD_H
#undef TYNDALL_MODES_FROXEL_FILL_LIGHT_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_FILL_LIGHT_SIMD_H
#endif

#include "base/random.h"
#include "integrate/shadow_rays_simd.h"
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

// Which surfaces light has to pass.
enum class Through { all, alpha };

// Share of the light that passes the surfaces on the way to each lane's point, one shadow ray each. `places` pick
// points of a soft light; null = its centre.
HWY_INLINE Floats visible_at_points(const Occluders& occluders, const Light& light, const FroxelLanes& lanes,
                                    const LightSamples& arrival, const Mask16& wanted, const Sample2* places,
                                    Through surfaces = Through::all) {
    Occluders::ShadowRays rays;
    aim_at_center(lanes.point, arrival, wanted, rays);
    for (size_t i = 0; i < 16 && places; ++i)
        if (rays.active[i]) aim_at_point(light, {places[i].x, places[i].y}, i, rays);
    alignas(64) float share[16] = {};
    if (surfaces == Through::all)
        occluders.transmission(rays, share);
    else
        occluders.alpha_transmission(rays, share);
    return load(share);
}
}
HWY_AFTER_NAMESPACE();
#endif

// A light as seen from 16 froxels (see base/simd/simd.h for how such files are compiled).
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
// 16 froxels of one slice: where light is evaluated, and the segment of a camera ray that each represents.
struct FroxelLanes {
    Vec3s point, step;   // in front of every surface; along the line, per meter of planar depth
    Floats z;            // planar depth of the point
    Vec3s start, toward; // of the segment; unit direction
    Floats length;       // of the segment, meters
    Floats width2;       // squared radius of a disk of the froxel's cross-section
    Mask16 active;
};

// Which surfaces can block the light.
enum class Through { all, alpha };

// Fraction of the light that surfaces let through to each lane's point, by one shadow ray each. `places` pick points of
// a soft light; null = its center.
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

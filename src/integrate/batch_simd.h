// Conversion between a RayBatch and SIMD kernels (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_BATCH_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_BATCH_SIMD_H
#undef TYNDALL_INTEGRATE_BATCH_SIMD_H
#else
#define TYNDALL_INTEGRATE_BATCH_SIMD_H
#endif

#include "base/simd/simd.h"
#include "integrate/ray_batch.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// The rays of a batch; unused lanes repeat the last ray.
struct Rays16 {
    Vec3s origin, direction;
    Floats t_max, jitter;
};

HWY_INLINE Rays16 rays_of(const RayBatch& batch) {
    alignas(64) float v[8][16];
    for (size_t lane = 0; lane < 16; ++lane) {
        const Ray& ray = batch.rays[std::min(lane, batch.rays.size() - 1)];
        for (int axis = 0; axis < 3; ++axis) v[axis][lane] = ray.origin[axis], v[3 + axis][lane] = ray.direction[axis];
        v[6][lane] = ray.t_max;
        v[7][lane] = lane < batch.jitter.size() ? batch.jitter[lane] : 0.5f;
    }
    return {{load(v[0]), load(v[1]), load(v[2])}, {load(v[3]), load(v[4]), load(v[5])}, load(v[6]), load(v[7])};
}

// Results for sixteen rays.
struct Scatter16 {
    Vec3s radiance;
    Floats transmittance, validity, steps;
};

HWY_INLINE void store_results(const Scatter16& scatter, std::span<Scatter> results) {
    alignas(64) float v[6][16];
    store(scatter.radiance.x, v[0]), store(scatter.radiance.y, v[1]), store(scatter.radiance.z, v[2]);
    store(scatter.transmittance, v[3]), store(scatter.validity, v[4]), store(scatter.steps, v[5]);
    for (size_t lane = 0; lane < results.size(); ++lane)
        results[lane] = {.radiance = vec3(v[0][lane], v[1][lane], v[2][lane]),
                         .transmittance = v[3][lane],
                         .validity = v[4][lane],
                         .steps = static_cast<int>(v[5][lane])};
}

// Adds to one part of the rays' light, if parts are requested.
HWY_INLINE void add_part(const Vec3s& light, size_t index, const RayBatch& batch) {
    if (batch.parts.empty()) return;
    alignas(64) float rgb[3][16];
    store(light.x, rgb[0]), store(light.y, rgb[1]), store(light.z, rgb[2]);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane)
        batch.part(lane, index) += vec3(rgb[0][lane], rgb[1][lane], rgb[2][lane]);
}
}
HWY_AFTER_NAMESPACE();
#endif

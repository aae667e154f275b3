// What kernels write to their batch (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_BATCH_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_BATCH_SIMD_H
#undef TYNDALL_MODES_BATCH_SIMD_H
#else
#define TYNDALL_MODES_BATCH_SIMD_H
#endif

#include "base/simd/simd.h"
#include "integrate/ray_batch.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Adds what one light gave the rays to RayBatch::per_light, where that is asked for.
HWY_INLINE void add_per_light(const Vec3s& light, size_t index, size_t light_count, const RayBatch& batch) {
    if (batch.per_light.empty()) return;
    alignas(64) float rgb[3][16];
    store(light.x, rgb[0]), store(light.y, rgb[1]), store(light.z, rgb[2]);
    for (size_t lane = 0; lane < batch.rays.size(); ++lane)
        batch.per_light[lane * light_count + index] += vec3(rgb[0][lane], rgb[1][lane], rgb[2][lane]);
}
}
HWY_AFTER_NAMESPACE();
#endif

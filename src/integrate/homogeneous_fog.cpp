#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrate/homogeneous_fog.cpp"
#include <hwy/foreach_target.h>

#include "integrate/homogeneous_fog.h"

#include "base/simd/simd.h"
#include "trace/transmittance/light_depth_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void dim_kernel(const std::vector<Medium>& media, const RayBatch& batch, std::span<Scatter> results) {
    alignas(64) float v[7][16] = {};
    for (size_t i = 0; i < batch.rays.size(); ++i) {
        const Ray& ray = batch.rays[i];
        for (int axis = 0; axis < 3; ++axis) v[axis][i] = ray.origin[axis], v[3 + axis][i] = ray.direction[axis];
        v[6][i] = std::min(ray.t_max, sun_distance);
    }
    const Segments16 paths{{load(v[0]), load(v[1]), load(v[2])}, {load(v[3]), load(v[4]), load(v[5])}, load(v[6])};
    Floats depth = 0.0f;
    for (const Medium& medium : media) depth = depth + analytic_depth16(medium, paths);
    alignas(64) float transmittance[16];
    store(exp(-depth), transmittance);
    for (size_t i = 0; i < batch.rays.size(); ++i) results[i] = {vec3(0), transmittance[i], 1, 0, vec3(0)};
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(dim_kernel);
ScatterFunction dimming_only(std::vector<Medium> media) {
    return [media = std::move(media)](const RayBatch& batch, std::span<Scatter> results) {
        HWY_DYNAMIC_DISPATCH(dim_kernel)(media, batch, results);
    };
}
}
#endif

// Artistic controls at sixteen points, for kernels compiled per instruction set (see base/simd/simd.h).
#if defined(TYNDALL_INTEGRATE_STYLE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_STYLE_SIMD_H
#undef TYNDALL_INTEGRATE_STYLE_SIMD_H
#else
#define TYNDALL_INTEGRATE_STYLE_SIMD_H
#endif

#include "base/simd/simd.h"
#include "integrate/style.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// style_fade() at points.
HWY_INLINE Floats style_fade(const StyleSettings& style, const Camera& camera, const Vec3s& point) {
    if (!fades(style)) return 1.0f;
    const Vec3s offset = point - splat(camera.position);
    const Floats distance = camera.ortho_height > 0 ? dot(offset, splat(camera.forward)) : sqrt(dot(offset, offset));
    return max(min((style.range - distance) * (5 / style.range), 1.0f), 0.0f);
}
}
HWY_AFTER_NAMESPACE();
#endif

// Phase functions of sixteen cosines, inside kernels compiled per instruction set (base/simd/simd.h says how).
#if defined(TYNDALL_VOLUME_PHASE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_PHASE_SIMD_H
#undef TYNDALL_VOLUME_PHASE_SIMD_H
#else
#define TYNDALL_VOLUME_PHASE_SIMD_H
#endif

#include "base/simd/simd.h"
#include "volume/phase.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// As phase_value() of volume/phase.h, to float rounding.
HWY_INLINE Floats phase_value(Phase phase, const Floats& cosine) {
    switch (phase.kind) {
    case PhaseKind::isotropic:
        break;
    case PhaseKind::rayleigh:
        return fused(cosine * cosine, 3 / (16 * pi), 3 / (16 * pi));
    case PhaseKind::henyey_greenstein: {
        const float g = std::min(std::abs(phase.g), largest_g);
        const Floats c = phase.g < 0 ? -cosine : cosine;
        const Floats q = max(fused(1.0f - c, 2 * g, (1 - g) * (1 - g)), 1e-7f);
        return Floats((1 - g * g) / (4 * pi)) / (q * sqrt(q));
    }
    case PhaseKind::schlick: {
        const float k = 1.55f * phase.g - 0.55f * phase.g * phase.g * phase.g;
        const Floats q = 1.0f - cosine * k;
        return Floats((1 - k * k) / (4 * pi)) / (q * q);
    }
    }
    return 1 / (4 * pi);
}
}
HWY_AFTER_NAMESPACE();
#endif

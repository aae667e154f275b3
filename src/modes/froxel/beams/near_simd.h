// The near part of a light for kernels (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_MODES_FROXEL_BEAMS_NEAR_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_MODES_FROXEL_BEAMS_NEAR_SIMD_H
#undef TYNDALL_MODES_FROXEL_BEAMS_NEAR_SIMD_H
#else
#define TYNDALL_MODES_FROXEL_BEAMS_NEAR_SIMD_H
#endif

#include "base/simd/simd.h"
#include "modes/froxel/beams/beams.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// As NearLight::at().
HWY_INLINE Floats near_share(const NearLight& near, const Floats& distance) {
    if (std::isinf(near.radius) || near.radius == 0) return near.radius > 0 ? 1.0f : 0.0f;
    const Floats x = max(min(2.0f - distance * (2 / near.radius), 1.0f), 0.0f);
    return x * x * (3.0f - x * 2.0f);
}

// Optical depth of LampFog from the lamp to a distance d, with an extinction ρ that falls off over its reach R: ρ R (1
// - e^(-d/R)).
HWY_INLINE Floats depth_at_lamp(const FroxelBeams::LampFog& fog, const Floats& distance) {
    if (fog.extinction == 0) return 0.0f;
    return (1.0f - exp(distance * (-1 / fog.reach))) * (fog.reach * fog.extinction);
}
}
HWY_AFTER_NAMESPACE();
#endif

// Equi-angular sampling along sixteen rays: uniform in the angle seen from a local light, which cancels 1/r² (Kulla &
// Fajardo 2012, section 4.1; see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_EQUI_ANGULAR_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_EQUI_ANGULAR_SIMD_H
#undef TYNDALL_INTEGRATE_EQUI_ANGULAR_SIMD_H
#else
#define TYNDALL_INTEGRATE_EQUI_ANGULAR_SIMD_H
#endif

#include "base/simd/angles_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Intervals relative to the points closest to the light: t = height · slope, slope = tan θ.
struct EquiAngular16 {
    Floats height, from, to; // slopes at the ends
    Floats angle;            // between them

    HWY_INLINE EquiAngular16(const Interval<Floats>& stretch, const Floats& away)
        : height(away), from(stretch.low / away), to(stretch.high / away), angle(angle_between(from, to)) {}

    // The slope at a share of the angle, by tan(α + β) = (tan α + tan β) / (1 - tan α tan β) from the nearer end,
    // because β must not exceed a right angle.
    HWY_INLINE Floats slope(const Floats& share) const {
        const Mask16 late = share > 0.5f;
        const Floats end = select(late, -to, from), further = tan(select(late, 1.0f - share, share) * angle);
        const Floats turned = (end + further) / max(1.0f - end * further, 1e-20f);
        return max(min(select(late, -turned, turned), to), from);
    }
    // Converts a quadrature weight over the shares to a length along the ray.
    HWY_INLINE Floats length(const Floats& weight, const Floats& at) const {
        return weight * angle * height * fma(at, at, 1.0f);
    }
};
}
HWY_AFTER_NAMESPACE();
#endif

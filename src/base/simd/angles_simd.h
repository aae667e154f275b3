// Tangent and arctangent for kernels (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_BASE_SIMD_ANGLES_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_BASE_SIMD_ANGLES_SIMD_H
#undef TYNDALL_BASE_SIMD_ANGLES_SIMD_H
#else
#define TYNDALL_BASE_SIMD_ANGLES_SIMD_H
#endif

#include "base/simd/simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Absolute error under 2e-7: Abramowitz & Stegun 4.4.49 up to 1, the complementary angle beyond.
HWY_INLINE Floats atan(const Floats& value) {
    const Floats size = abs(value);
    const Mask16 steep = size > 1.0f;
    const Floats x = select(steep, 1.0f / max(size, 1.0f), size), s = x * x;
    Floats p = fma(s, 0.0028662257f, -0.0161657367f);
    p = fma(p, s, 0.0429096138f), p = fma(p, s, -0.0752896400f), p = fma(p, s, 0.1065626393f);
    p = fma(p, s, -0.1420889944f), p = fma(p, s, 0.1999355085f), p = fma(p, s, -0.3333314528f);
    p = fma(p, s, 1.0f) * x;
    const Floats angle = select(steep, 0.5f * pi - p, p);
    return select(value < 0.0f, -angle, angle);
}

// For angles in -π/2..π/2: relative error under 3e-7 up to π/4 (Abramowitz & Stegun 4.3.101), the complementary angle
// beyond.
HWY_INLINE Floats tan(const Floats& angle) {
    const Floats size = abs(angle);
    const Mask16 steep = size > 0.25f * pi;
    const Floats x = select(steep, max(0.5f * pi - size, 0.0f), size), s = x * x;
    Floats p = fma(s, 0.0095168091f, 0.0029005250f);
    p = fma(p, s, 0.0245650893f), p = fma(p, s, 0.0533740603f), p = fma(p, s, 0.1333923995f);
    p = fma(p, s, 0.3333314036f);
    p = fma(p, s, 1.0f) * x;
    const Floats value = select(steep, 1.0f / max(p, 1e-20f), p);
    return select(angle < 0.0f, -value, value);
}

// atan(b) - atan(a) for b >= a, without cancellation when both are large.
HWY_INLINE Floats angle_between(const Floats& a, const Floats& b) {
    const Floats below = fma(a, b, 1.0f), above = b - a;
    const Mask16 wide = below <= 0.0f; // a right angle or more
    const Floats turned = atan(above / select(abs(below) < 1e-30f, 1e-30f, below));
    return select(wide & (turned < 0.0f), turned + pi, turned);
}
}
HWY_AFTER_NAMESPACE();
#endif

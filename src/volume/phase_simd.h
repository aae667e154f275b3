// Phase functions at sixteen cosines, for kernels compiled per instruction set (see base/simd/simd.h).
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
// SIMD version of lobe_value().
HWY_INLINE Floats lobe_value(const PhaseLobe& lobe, const Floats& cosine) {
    const Floats beside = max(1.0f - (lobe.g < 0 ? -cosine : cosine), 0.0f);
    const Floats q = fma(beside, lobe.slope, lobe.gap);
    return fma(cosine * cosine, lobe.scale_of_square, lobe.scale) / (q * sqrt(q));
}

// SIMD version of table_value().
HWY_INLINE Floats table_value(const PhaseTable& table, const Floats& cosine) {
    const float half = static_cast<float>(table.half);
    const Floats square = max(1.0f - abs(cosine), 0.0f) * (half * half);
    const Floats first = max(min(floor(sqrt(square)), half - 1), 0.0f);
    const Floats share = (square - first * first) / fma(first, 2.0f, 1.0f);
    const Mask16 back = cosine < 0.0f;
    const Ints a = truncate(select(back, 2 * half - first, first)),
               b = truncate(select(back, 2 * half - 1 - first, first + 1.0f));
    const Floats from = gather(table.values.data(), a), to = gather(table.values.data(), b);
    return fma(share, to - from, from);
}

// SIMD version of shape_value(). Not inlined, to keep it out of loops over simpler phase functions.
HWY_NOINLINE inline Floats shape_value(const PhaseShape& shape, const Floats& cosine) {
    if (shape.lobes.empty()) return table_value(shape.table, cosine);
    Floats sum = 0.0f;
    for (const PhaseLobe& lobe : shape.lobes) sum = sum + lobe_value(lobe, cosine);
    return sum;
}

// SIMD version of phase_value() (volume/phase.h), equal up to float rounding.
HWY_INLINE Floats phase_value(const Phase& phase, const Floats& cosine) {
    switch (phase.kind) {
    case PhaseKind::isotropic:
        break;
    case PhaseKind::rayleigh:
        return fma(cosine * cosine, 3 / (16 * pi), 3 / (16 * pi));
    case PhaseKind::henyey_greenstein: {
        const float g = std::min(std::abs(phase.g), largest_g);
        const Floats c = phase.g < 0 ? -cosine : cosine;
        const Floats q = max(fma(1.0f - c, 2 * g, (1 - g) * (1 - g)), 1e-7f);
        return Floats((1 - g * g) / (4 * pi)) / (q * sqrt(q));
    }
    case PhaseKind::schlick: {
        const float k = 1.55f * phase.g - 0.55f * phase.g * phase.g * phase.g;
        const Floats q = 1.0f - cosine * k;
        return Floats((1 - k * k) / (4 * pi)) / (q * q);
    }
    default:
        return shape_value(*phase.shape, cosine);
    }
    return 1 / (4 * pi);
}
}
HWY_AFTER_NAMESPACE();
#endif

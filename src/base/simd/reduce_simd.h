// Horizontal reductions of sixteen floats (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_BASE_SIMD_REDUCE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_BASE_SIMD_REDUCE_SIMD_H
#undef TYNDALL_BASE_SIMD_REDUCE_SIMD_H
#else
#define TYNDALL_BASE_SIMD_REDUCE_SIMD_H
#endif

#include "base/simd/simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
HWY_INLINE float least(const Floats& a) {
    auto result = a.part[0];
    for (size_t i = 1; i < vectors_per_packet; ++i) result = hn::Min(result, a.part[i]);
    return hn::GetLane(hn::MinOfLanes(FloatTag(), result));
}
HWY_INLINE float most(const Floats& a) { return -least(-a); }
}
HWY_AFTER_NAMESPACE();
#endif

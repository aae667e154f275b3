// Gathers of adjacent floats (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_BASE_SIMD_GATHER_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_BASE_SIMD_GATHER_SIMD_H
#undef TYNDALL_BASE_SIMD_GATHER_SIMD_H
#else
#define TYNDALL_BASE_SIMD_GATHER_SIMD_H
#endif

#include "base/simd/simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// base[index] and base[index + 1], in half the reads of two gathers.
HWY_INLINE void gather_pairs(const float* base, const Ints& index, Floats& first, Floats& second) {
    using PairTag = hn::ScalableTag<int64_t>;
    const auto gathered = [&](const auto& half) HWY_ATTR {
        const auto offset = hn::ShiftLeft<2>(hn::PromoteTo(PairTag(), half));
        return hn::BitCast(FloatTag(), hn::GatherOffset(PairTag(), reinterpret_cast<const int64_t*>(base), offset));
    };
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const auto low = gathered(hn::LowerHalf(hn::Half<IntTag>(), index.part[i]));
        const auto high = gathered(hn::UpperHalf(hn::Half<IntTag>(), index.part[i]));
        first.part[i] = hn::ConcatEven(FloatTag(), high, low);
        second.part[i] = hn::ConcatOdd(FloatTag(), high, low);
    }
}
}
HWY_AFTER_NAMESPACE();
#endif

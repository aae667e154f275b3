#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/bricks/half.cpp"
#include <hwy/foreach_target.h>

#include "volume/bricks/half.h"

#include "base/simd/simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
// Rounding is monotonic, so the range of the halves is the rounded range of the floats.
HalfRange halves_kernel(const float* from, size_t count, uint16_t* to) {
    using HalfTag = hn::Rebind<hwy::float16_t, FloatTag>;
    using BitsTag = hn::Rebind<uint16_t, FloatTag>;
    const auto zero = hn::Zero(FloatTag()), most = hn::Set(FloatTag(), largest_half);
    auto low = most, high = zero;
    size_t i = 0;
    for (; i + lane_step <= count; i += lane_step) {
        // Max returns its second operand for NaN.
        const auto value = hn::Min(hn::Max(hn::LoadU(FloatTag(), from + i), zero), most);
        low = hn::Min(low, value), high = hn::Max(high, value);
        hn::StoreU(hn::BitCast(BitsTag(), hn::DemoteTo(HalfTag(), value)), BitsTag(), to + i);
    }
    HalfRange range{half_from_float(hn::GetLane(hn::MinOfLanes(FloatTag(), low))),
                    half_from_float(hn::GetLane(hn::MaxOfLanes(FloatTag(), high)))};
    for (; i < count; ++i) {
        to[i] = half_from_float(from[i]);
        range.low = std::min(range.low, to[i]), range.high = std::max(range.high, to[i]);
    }
    return range;
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(halves_kernel);
HalfRange halves_from_floats(const float* from, size_t count, uint16_t* to) {
    return HWY_DYNAMIC_DISPATCH(halves_kernel)(from, count, to);
}
}
#endif

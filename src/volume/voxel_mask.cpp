#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/voxel_mask.cpp"
#include <hwy/foreach_target.h>

#include "base/simd.h"
#include "volume/voxel_mask.h"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
void mask_kernel(const float* values, float threshold, uint64_t* words) {
    using Bits = std::conditional_t<(lane_step > 8), uint16_t, uint8_t>;
    const auto bound = hn::Set(FloatTag(), threshold);
    for (size_t w = 0; w < 8; ++w) {
        uint64_t word = 0;
        for (size_t i = 0; i < 64; i += lane_step) {
            uint8_t bytes[8] = {}; // Highway may write eight
            hn::StoreMaskBits(FloatTag(), hn::Gt(hn::LoadU(FloatTag(), values + w * 64 + i), bound), bytes);
            Bits bits;
            std::memcpy(&bits, bytes, sizeof bits);
            word |= uint64_t{bits} << i;
        }
        words[w] = word;
    }
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(mask_kernel);
VoxelMask voxels_above(std::span<const float, 512> values, float threshold) {
    VoxelMask mask;
    HWY_DYNAMIC_DISPATCH(mask_kernel)(values.data(), threshold, mask.data());
    return mask;
}
}
#endif

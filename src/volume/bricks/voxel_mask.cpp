#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/bricks/voxel_mask.cpp"
#include <hwy/foreach_target.h>

#include "base/simd/simd.h"
#include "volume/bricks/voxel_mask.h"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
void mask_kernel(const float* values, float threshold, uint64_t* words) {
    using Bits = std::conditional_t<(lane_step > 8), uint16_t, uint8_t>;
    const auto bound = hn::Set(FloatTag(), threshold);
    for (size_t w = 0; w < 8; ++w) {
        uint64_t word = 0;
        for (size_t i = 0; i < 64; i += lane_step) {
            uint8_t bytes[8] = {}; // StoreMaskBits may write 8 bytes
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

void bounds_of(const VoxelMask& mask, ivec3& low, ivec3& high) {
    uint64_t rows = 0; // bit y·8 + z
    for (const uint64_t word : mask) rows |= word;
    std::array<uint32_t, 3> used{}; // one bit per layer along x, y, z
    for (uint32_t i = 0; i < 8; ++i) {
        const uint32_t row = rows >> (8 * i) & 0xff;
        used[0] |= uint32_t{mask[i] != 0} << i, used[1] |= uint32_t{row != 0} << i, used[2] |= row;
    }
    for (int axis = 0; axis < 3; ++axis)
        low[axis] = std::countr_zero(used[axis]), high[axis] = std::bit_width(used[axis]) - 1;
}
}
#endif

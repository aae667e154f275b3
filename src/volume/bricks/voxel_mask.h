// One bit for each voxel of a leaf.
#pragma once
#include "base/math.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tyndall {
using VoxelMask = std::array<uint64_t, 8>; // bit x·64 + y·8 + z

// The voxels whose value exceeds a threshold; NaN never does.
VoxelMask voxels_above(std::span<const float, 512> values, float threshold);

// Bounding box (inclusive, 0..7) of the voxels in a nonempty mask.
void bounds_of(const VoxelMask& mask, ivec3& low, ivec3& high);

inline bool contains(const VoxelMask& mask, uint32_t v) { return mask[v / 64] >> (v % 64) & 1; }

inline size_t count_voxels(const VoxelMask& mask) {
    size_t sum = 0;
    for (const uint64_t word : mask) sum += static_cast<size_t>(std::popcount(word));
    return sum;
}
}

// A bit for each voxel of a leaf.
#pragma once
#include "base/math.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tyndall {
using VoxelMask = std::array<uint64_t, 8>; // bit x·64 + y·8 + z

// The voxels whose value is above a threshold; not-a-number never is.
VoxelMask voxels_above(std::span<const float, 512> values, float threshold);

// Corners, 0..7, of the box around the voxels of a mask that holds some.
void bounds_of(const VoxelMask& mask, ivec3& low, ivec3& high);

inline size_t count_voxels(const VoxelMask& mask) {
    size_t sum = 0;
    for (const uint64_t word : mask) sum += static_cast<size_t>(std::popcount(word));
    return sum;
}
}

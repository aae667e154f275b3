// Density ready for sampling: 8³-cell bricks of half floats with the next voxel of each neighbour (9³ values), found
// through a dense index. Sampling is trilinear between voxel centres; outside the active box the density is 0.
//
//   index[(bx·ny + by)·nz + bz] : 0 = empty · n > 0 = brick n-1 · n < 0 = constant brick, value constants[-n-1]
//   values[brick·736 + (x·9 + y)·9 + z] : value at voxel low + 8·b + (x,y,z); 729 used, padded for pair loads
#pragma once
#include "volume/sparse_volume.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tyndall {
inline constexpr int brick_stride = 736;

struct BrickPool {
    ivec3 low{0};                     // index-space voxel at the lower corner of brick (0,0,0); a multiple of 8, minus 8
    ivec3 size{0};                    // bricks along each axis
    std::vector<int32_t> index;
    std::vector<uint16_t> values;     // half floats
    std::vector<float> constants;
    std::vector<float> maximum;       // per cell of `index`: largest value inside, apron included (the majorant)
    mat4 world_to_index{1};
    mat4 index_to_world{1};
    Box bounds;                       // world box around everything that is not empty
    float highest = 0;                // largest value anywhere
    vec3 voxel_size{0};               // world lengths of the index axes

    uint64_t bytes() const;
};

// Throws Error (out_of_memory) when the index alone would pass 256 MB.
std::shared_ptr<const BrickPool> make_bricks(const SparseVolume& volume);

// One sample, the plain way: the definition the vector sampler is tested against.
float sample_density(const BrickPool& pool, vec3 world_point);
}

// Density ready for sampling: 8³-cell bricks of half floats with the next voxel of each neighbour (9³ values), found
// through a dense index. Sampling is trilinear between voxel centres; outside the active box the density is 0.
//
//   index[(bx·ny + by)·nz + bz] : 0 = empty · n > 0 = brick n-1 · n < 0 = constant brick, value constants[-n-1]
//   values[brick·736 + (x·9 + y)·9 + z] : value at voxel low + 8·b + (x,y,z); 729 used, padded to whole cache lines
//
// Local coordinates are index coordinates less `low`: 0..8·size along each axis. The first and the last voxel layer of
// that range are always 0, so a coordinate clamped to 0..8·size-1 has the density of the point outside: none.
#pragma once
#include "base/shared_array.h"
#include "volume/bricks/sparse_volume.h"

#include <cstdint>
#include <memory>
#include <string>

namespace tyndall {
inline constexpr int brick_stride = 736;

struct BrickPool {
    ivec3 low{0};  // index-space voxel at the lower corner of brick (0,0,0); a multiple of 8
    ivec3 size{0}; // bricks along each axis
    SharedArray<int32_t> index;
    SharedArray<uint16_t> values;        // half floats; densities above 65504 are stored as that
    SharedArray<float> constants;        // exactly representable as halves, as the values are
    SharedArray<float> minimum, maximum; // per cell of `index`: least and largest value inside, apron included
    mat4 world_to_index{1};              // to local coordinates and back
    mat4 index_to_world{1};
    vec3 anchor{0};           // a world point in the fog, and its local coordinates: differences from it stay
    vec3 anchor_index{0};     // exact where the fog lies far from the origin
    Box bounds;               // world box around everything that is not empty
    Box local_bounds;         // the same in local coordinates
    float highest = 0;        // largest value anywhere
    bool crowded = false;     // hardly a brick is empty: a ray inside `local_bounds` meets fog almost all the way
    double mass = 0;          // integral of the density over index space
    float mean = 0;           // over `bounds`: homogeneous fog of this density there has the same mass
    float mean_in_bricks = 0; // over the bricks that are not empty
    vec3 voxel_size{0};       // world lengths of the index axes
    std::string content;      // says in every process what this is made from and where it lies; empty = nobody asked

    uint64_t bytes() const;
    bool empty() const { return index.empty(); }
};

// Of cache files, in this order; not `content`.
template<class Visit> void fields(BrickPool& pool, Visit& visit) {
    visit(pool.low), visit(pool.size);
    visit(pool.index), visit(pool.values), visit(pool.constants), visit(pool.minimum), visit(pool.maximum);
    visit(pool.world_to_index), visit(pool.index_to_world), visit(pool.anchor), visit(pool.anchor_index);
    visit(pool.bounds), visit(pool.local_bounds), visit(pool.highest), visit(pool.crowded);
    visit(pool.mass), visit(pool.mean), visit(pool.mean_in_bricks), visit(pool.voxel_size);
}

// Throws what make_bricks() would for want of room for the index alone.
void check_bricks(const SparseVolume& volume);

// Throws Error: out_of_memory when the index alone would pass 256 MB or the bricks the memory of this machine, refused
// when the transform has no inverse.
std::shared_ptr<const BrickPool> make_bricks(const SparseVolume& volume);

// Moves the fog to where `index_to_world` puts the volume's index space (not the local one). The densities stay.
void place(BrickPool& pool, const dmat4& index_to_world);

// Local coordinates of a world point.
vec3 local_point(const BrickPool& pool, vec3 world_point);

// One sample, the plain way: the definition the vector sampler is tested against.
float sample_density(const BrickPool& pool, vec3 world_point);
}

// Density prepared for sampling: bricks of 8³ cells as half floats, with an apron of one voxel on the upper sides (9³
// values), found through a dense index. Sampling is trilinear between voxel centers; outside the active box the density
// is 0.
//
//   index[(bx·ny + by)·nz + bz] : 0 = empty · n > 0 = brick n-1 · n < 0 = constant brick, value constants[-n-1]
//   values[brick·736 + (x·9 + y)·9 + z] : value at voxel low + 8·b + (x,y,z); 729 used, padded to whole cache lines
//
// Local coordinates are index coordinates minus `low`: 0..8·size along each axis. The first and last voxel layers of
// that range are always 0, so points outside can be clamped to 0..8·size-1 and still have density 0.
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
    SharedArray<uint16_t> values;        // half floats; densities are clamped to 65504
    SharedArray<float> constants;        // rounded to half precision like `values`
    SharedArray<float> minimum, maximum; // per cell of `index`: smallest and largest value inside, apron included
    mat4 world_to_index{1};              // to and from local coordinates
    mat4 index_to_world{1};
    vec3 anchor{0};           // a world point in the fog, and its local coordinates: differences from it
    vec3 anchor_index{0};     // stay accurate if the fog is far from the origin
    Box bounds;               // world box around all nonzero density
    Box local_bounds;         // the same in local coordinates
    float highest = 0;        // largest value anywhere
    bool crowded = false;     // almost no brick is empty: rays inside `local_bounds` are nearly always in fog
    double mass = 0;          // integral of the density over index space
    float mean = 0;           // over `bounds`: homogeneous fog of this density has the same mass
    float mean_in_bricks = 0; // over the nonempty bricks
    vec3 voxel_size{0};       // world lengths of the index axes
    std::string content;      // identifies source and placement across processes; empty = not requested

    uint64_t bytes() const;
    bool empty() const { return index.empty(); }
};

// The fields of cache files, in this order; excludes `content`.
template<class Visit> void fields(BrickPool& pool, Visit& visit) {
    visit(pool.low), visit(pool.size);
    visit(pool.index), visit(pool.values), visit(pool.constants), visit(pool.minimum), visit(pool.maximum);
    visit(pool.world_to_index), visit(pool.index_to_world), visit(pool.anchor), visit(pool.anchor_index);
    visit(pool.bounds), visit(pool.local_bounds), visit(pool.highest), visit(pool.crowded);
    visit(pool.mass), visit(pool.mean), visit(pool.mean_in_bricks), visit(pool.voxel_size);
}

// Why the index of the volume's bricks is too large; empty if it is not.
std::string bricks_problem(const SparseVolume& volume);

// Throws as make_bricks() does if the index alone is too large.
void check_bricks(const SparseVolume& volume);

// Throws Error: out_of_memory if the index alone exceeds 256 MB or the bricks exceed this machine's memory; refused if
// the transform is not invertible.
std::shared_ptr<const BrickPool> make_bricks(const SparseVolume& volume);

// Sets the transform from the volume's index space (not the local one) to world space. Densities are unchanged.
void place(BrickPool& pool, const dmat4& index_to_world);

// Local coordinates of a world point.
vec3 local_point(const BrickPool& pool, vec3 world_point);

// Scalar reference sampler that the SIMD sampler is tested against.
float sample_density(const BrickPool& pool, vec3 world_point);
}

// A fog grid as plain data: the contents of a VDB file, independent of the library that reads it.
// Index space: the center of voxel (i,j,k) is at (i,j,k). Values are densities, 0..1 by convention.
#pragma once
#include "base/math.h"
#include "volume/bricks/leaf_memory.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tyndall {
// 8×8×8 voxels, z fastest: the value at origin + (x,y,z) is at [x·64 + y·8 + z]. `origin` is a multiple of 8.
struct Leaf {
    ivec3 origin{0};
    std::array<float, 512> values{};
};

using Leaves = std::vector<Leaf, LeafMemory<Leaf>>;

// A box of voxels low..high (inclusive) with one value.
struct Tile {
    ivec3 low{0}, high{0};
    float value = 0;
};

inline double voxels_in(const Tile& tile) {
    const dvec3 size = dvec3(tile.high) - dvec3(tile.low) + 1.0;
    return size.x * size.y * size.z;
}

struct SparseVolume {
    std::string name = "density";
    dmat4 index_to_world{1};
    Leaves leaves;                        // no two share an origin
    std::vector<Tile> tiles;              // disjoint from the leaves and each other
    ivec3 active_low{0}, active_high{-1}; // box of the active voxels, inclusive; high < low = empty
    std::vector<std::pair<std::string, std::string>> metadata;

    bool empty() const { return active_high.x < active_low.x; }
};
}

// What bricks are made of, cell by cell: leaves, and tiles that cover a cell whole. Internal to make_bricks().
#pragma once
#include "volume/bricks/bricks.h"

namespace tyndall {
struct VoxelBox {
    ivec3 low{std::numeric_limits<int>::max()}, high{std::numeric_limits<int>::min()};

    bool empty() const { return high.x < low.x; }
    void grow(const VoxelBox& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
};

// What of a leaf is not 0. Bit d of `parts`: some voxel that the brick at -d (d = 4·dx + 2·dy + dz) has as a corner.
struct LeafSummary {
    VoxelBox box;
    uint8_t parts = 0;
    double mass = 0; // sum of the voxels
};

// Everything a brick can be made of, by cell of 8³ voxels: n > 0 = leaf n-1, n < 0 = tile -n-1 covers it, 0 = nothing.
struct Sources {
    std::vector<const Leaf*> leaves;
    std::vector<LeafSummary> summaries;
    std::vector<Leaf> partial;   // made from tiles that cover a cell in part
    std::vector<uint16_t> tiles; // values as halves
    std::vector<int32_t> cells;
    VoxelBox box;    // of the voxels that are not 0
    double mass = 0; // sum of all voxels
};

// Summaries of the leaves and the box of all fog; the cells are still to be filled.
Sources make_sources(const SparseVolume& volume);

// Fills `cells` on the pool's grid of bricks.
void fill_cells(const BrickPool& pool, const SparseVolume& volume, Sources& sources);

inline int64_t cell_count(const BrickPool& pool) { return int64_t{pool.size.x} * pool.size.y * pool.size.z; }

inline int64_t cell_at(const BrickPool& pool, ivec3 cell) {
    return (int64_t{cell.x} * pool.size.y + cell.y) * pool.size.z + cell.z;
}
}

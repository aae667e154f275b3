// Source data of each brick cell: leaves, and tiles that cover a whole cell. Internal to make_bricks().
#pragma once
#include "volume/bricks/bricks.h"

namespace tyndall {
struct VoxelBox {
    ivec3 low{std::numeric_limits<int>::max()}, high{std::numeric_limits<int>::min()};

    bool empty() const { return high.x < low.x; }
    void grow(const VoxelBox& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
};

// The nonzero part of a leaf. Bit d of `parts` is set if a nonzero voxel is a corner of the brick at offset -(dx, dy,
// dz), where d = 4·dx + 2·dy + dz.
struct LeafSummary {
    VoxelBox box;
    uint8_t parts = 0;
    double mass = 0; // sum of the voxels
};

// The sources of all bricks. `cells` holds, for each cell of 8³ voxels: n > 0 = leaf n-1, n < 0 = tile -n-1, 0 = empty.
struct Sources {
    std::vector<const Leaf*> leaves;
    std::vector<LeafSummary> summaries;
    std::vector<Leaf> partial;   // from tiles that cover a cell only in part
    std::vector<uint16_t> tiles; // values as halves
    std::vector<int32_t> cells;
    VoxelBox box;    // around the nonzero voxels
    double mass = 0; // sum of all voxels
};

// Summarizes the leaves and the box of all fog; `cells` stays empty.
Sources make_sources(const SparseVolume& volume);

// Fills `cells` on the pool's brick grid.
void fill_cells(const BrickPool& pool, const SparseVolume& volume, Sources& sources);

inline int64_t cell_count(const BrickPool& pool) { return int64_t{pool.size.x} * pool.size.y * pool.size.z; }

inline int64_t cell_at(const BrickPool& pool, ivec3 cell) {
    return (int64_t{cell.x} * pool.size.y + cell.y) * pool.size.z + cell.z;
}
}

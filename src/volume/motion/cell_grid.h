// A box of cells of 8³ voxels, and leaves built for some of them. Internal to moved_fog.cpp.
#pragma once
#include "volume/bricks/bricks.h"

#include <functional>
#include <string>
#include <vector>

namespace tyndall {
// Cells first..first + size - 1; cell c holds the voxels 8c..8c + 7.
struct CellGrid {
    ivec3 first{0}, size{0};

    size_t count() const { return size_t(size.x) * size_t(size.y) * size_t(size.z); }
    size_t at(ivec3 cell) const {
        const ivec3 c = cell - first;
        return (size_t(c.x) * size_t(size.y) + size_t(c.y)) * size_t(size.z) + size_t(c.z);
    }
};

// Calls body(cell) for each cell in low..high, inclusive.
template<class Body> void for_each_cell(ivec3 low, ivec3 high, const Body& body) {
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z) body(ivec3(x, y, z));
}

// The cells of a pool's nonempty bricks.
std::vector<ivec3> filled_cells(const BrickPool& pool);

// The grid around a box of voxels. Throws Error (refused) if it would exceed 2^24 cells.
CellGrid cells_around(dvec3 low, dvec3 high, const std::string& what);

// Builds leaves for the cells and fills them in parallel by fill(cell, leaf). Throws Error (out_of_memory).
Leaves filled_leaves(const std::vector<ivec3>& cells, const std::string& what,
                     const std::function<void(ivec3 cell, Leaf& leaf)>& fill);
}

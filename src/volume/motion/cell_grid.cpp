#include "volume/motion/cell_grid.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/process.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr double max_cells = 1 << 24;
}

std::vector<ivec3> filled_cells(const BrickPool& pool) {
    std::vector<ivec3> cells;
    size_t at = 0;
    for_each_cell(ivec3(0), pool.size - 1, [&](ivec3 cell) {
        if (pool.index[at++] != 0) cells.push_back(pool.low / 8 + cell);
    });
    return cells;
}

CellGrid cells_around(dvec3 low, dvec3 high, const std::string& what) {
    const dvec3 first = glm::floor(low / 8.0), count = glm::floor(high / 8.0) - first + 1.0;
    if (!(count.x * count.y * count.z <= max_cells))
        refuse(what,
               "it spreads over too many voxels while the shutter is open; its velocity or scale may be in the wrong "
               "unit");
    return {ivec3(first), ivec3(count)};
}

Leaves filled_leaves(const std::vector<ivec3>& cells, const std::string& what,
                     const std::function<void(ivec3 cell, Leaf& leaf)>& fill) {
    const double bytes = static_cast<double>(cells.size()) * sizeof(Leaf);
    if (bytes > static_cast<double>(physical_memory()) / 2)
        fail(ExitCode::out_of_memory, what,
             "its voxels take " + std::to_string(static_cast<int64_t>(bytes / 1e6)) +
                 " MB while the shutter is open. Use larger voxels");
    Leaves leaves(cells.size());
    parallel_ranges(static_cast<int64_t>(cells.size()), 4, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            leaves[i].origin = cells[i] * 8;
            fill(cells[i], leaves[i]);
        }
    });
    return leaves;
}
}

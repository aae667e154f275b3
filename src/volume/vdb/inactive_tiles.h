// The inactive tiles of a tree, of which a few bytes of a file make thousands.
#pragma once
#include "volume/vdb/fog.h"
#include "volume/vdb/memory.h"

namespace tyndall {
// Whether a tile has the value of a box before it, and goes on along z where that ends.
inline bool goes_on(const Tile& before, const Tile& tile) {
    return before.value == tile.value && before.high.z + 1 == tile.low.z && before.low.x == tile.low.x &&
           before.low.y == tile.low.y && before.high.x == tile.high.x && before.high.y == tile.high.y;
}

// Stores in `result`, whose active voxels are complete, those inactive tiles that belong to the fog, and equal ones in
// a row along z as one. `visit_all(visit)` visits every inactive tile; they are counted before any is stored. Throws
// Error like check_tree().
template<class VisitAll>
void store_inactive_tiles(const VisitAll& visit_all, uint64_t bytes, const std::string& where, VdbTreeCounts& counts,
                          DecodedTree& result) {
    const ActiveBox box = active_box(result);
    const auto visit_rows = [&](const auto& visit) {
        Tile row; // 0: none yet
        visit_all([&](const Tile& tile) {
            if (!box.takes(tile)) return;
            if (goes_on(row, tile)) {
                row.high.z = tile.high.z;
                return;
            }
            if (row.value != 0) visit(row);
            row = tile;
        });
        if (row.value != 0) visit(row);
    };
    counts.inactive_tiles = 0;
    visit_rows([&](const Tile&) { ++counts.inactive_tiles; });
    check_tree(counts, bytes, where);
    result.inactive_tiles.reserve(counts.inactive_tiles);
    visit_rows([&](const Tile& row) { result.inactive_tiles.push_back(row); });
}
}

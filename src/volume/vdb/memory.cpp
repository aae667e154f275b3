#include "volume/vdb/memory.h"

#include "base/error.h"
#include "base/memory.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/bricks/voxel_mask.h"

namespace tyndall {
uint64_t memory_needed(const VdbTreeCounts& counts) {
    const uint64_t leaf = 128 + sizeof(Leaf) + sizeof(VoxelMask) + sizeof(uint64_t);
    return counts.leaves * leaf + counts.lower_nodes * (4096 * 8 + 1100) + counts.upper_nodes * (32768 * 8 + 8300) +
           counts.root_tiles * 160 + (counts.active_tiles + counts.inactive_tiles) * sizeof(Tile);
}

void check_tree(const VdbTreeCounts& counts, uint64_t bytes, const std::string& where) {
    constexpr uint64_t max_tiles = uint64_t{1} << 26; // a few bytes in a file can expand to thousands of tiles
    const uint64_t tiles = counts.active_tiles + counts.inactive_tiles;
    if (tiles > max_tiles)
        refuse(where, "has " + std::to_string(tiles) + " tiles inside the bounding box of its active voxels; at most " +
                          std::to_string(max_tiles) + " are supported");
    check_memory(bytes + memory_needed(counts), where);
}

void check_memory(uint64_t bytes, const std::string& where) {
    const uint64_t available = available_memory();
    if (bytes <= available) return;
    fail(ExitCode::out_of_memory, where,
         "needs " + std::to_string(bytes >> 20) + " MB of memory, only " + std::to_string(available >> 20) +
             " MB are available");
}
}

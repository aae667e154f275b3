// Describes the grids of a file.
#include "volume/bricks/bricks.h"
#include "volume/vdb/choose.h"
#include "volume/vdb/fog.h"
#include "volume/vdb/load.h"
#include "volume/vdb/memory.h"

namespace tyndall {
namespace {
// Marks a grid that spans too many voxels as not usable.
void check_size(DecodedTree tree, const VdbGridEntry& grid, const ByteCursor& file, VdbGridInfo& info) {
    VdbReadReport unused;
    info.why_not = bricks_problem(cleaned_volume(std::move(tree), grid, file, unused));
    info.usable = info.why_not.empty(), info.is_fog &= info.usable;
}

VdbGridInfo grid_info(ByteCursor& file, const VdbDirectory& directory, const VdbGridEntry& grid) {
    VdbGridInfo info;
    info.name = grid.name, info.type = grid.type, info.grid_class = grid.grid_class;
    info.key = key_of(directory, grid), info.role = role_of(grid);
    info.why_not = grid_problem(grid), info.usable = info.why_not.empty(),
    info.is_fog = default_grid(directory) == &grid;
    info.index_to_world = grid.index_to_world;
    for (int axis = 0; axis < 3; ++axis)
        info.voxel_size[axis] = static_cast<float>(glm::length(dvec3(grid.index_to_world[axis])));
    info.metadata = grid.metadata;
    if (!is_walkable(grid)) return info;

    VdbTreeCounts counts;
    const bool numbers = is_scalar_float(grid), vectors = is_vector_float(grid);
    if (numbers || vectors) {
        for (int component = vectors ? 2 : 0; component >= 0; --component) {
            DecodedTree tree = load_tree(file, directory, grid, counts, component);
            const ActiveBox box = active_box(tree);
            info.active_low = box.low, info.active_high = box.high;
            add_statistics(tree, info);
            if (vectors) info.ranges.insert(info.ranges.begin(), {info.minimum, info.maximum});
            if (info.usable && tree.background == 0) check_size(std::move(tree), grid, file, info);
        }
    } else {
        const std::string where = std::exchange(file.where, label(file, grid));
        file.seek(grid.tree_begin, "the grid");
        counts = walk_tree(file, grid);
        file.where = where;
    }
    info.active_voxels = counts.active_voxels, info.leaves = counts.leaves, info.tiles = counts.active_tiles;
    info.memory_bytes = memory_needed(counts);
    return info;
}

VdbInfo file_info(const std::filesystem::path& path) {
    ByteCursor file(path);
    const VdbDirectory directory = read_grids(file);
    VdbInfo info;
    info.format = directory.nano ? "NanoVDB" : "OpenVDB", info.file_version = directory.file_version;
    info.library_version = std::to_string(directory.library_major) + "." + std::to_string(directory.library_minor);
    info.compression = compression_name(directory.grids.front().compression);
    info.metadata = directory.metadata;
    for (const VdbGridEntry& grid : directory.grids) info.grids.push_back(grid_info(file, directory, grid));
    return info;
}
}

VdbInfo vdb_info(const std::filesystem::path& path) {
    return within_memory(path, [&] { return file_info(path); });
}
}

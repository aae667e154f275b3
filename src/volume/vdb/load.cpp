#include "volume/vdb/load.h"

#include "volume/vdb/choose.h"
#include "volume/vdb/fog.h"
#include "volume/vdb/memory.h"
#include "volume/vdb/nano/file.h"
#include "volume/vdb/nano/tree.h"

namespace tyndall {
namespace {
DecodedTree load_nano_tree(ByteCursor& file, const VdbGridEntry& grid, VdbTreeCounts& counts, int component) {
    const std::string where = label(file, grid);
    check_memory(grid.nano_bytes, where);
    const LargeBytes memory = unpacked_grid(file, grid);
    return decode_nano_tree({memory.get(), grid.nano_bytes}, grid, counts, where, component);
}
}

VdbDirectory read_grids(ByteCursor& file) {
    VdbDirectory directory = read_directory(file);
    if (directory.grids.empty()) refuse(file.where, "contains no grids");
    return directory;
}

DecodedTree load_tree(ByteCursor& file, const VdbDirectory& directory, const VdbGridEntry& grid, VdbTreeCounts& counts,
                      int component) {
    if (directory.nano) return load_nano_tree(file, grid, counts = {}, component);
    const std::string where = label(file, grid);
    const uint64_t size = grid.tree_end - grid.tree_begin;
    check_memory(size, where);
    file.seek(grid.tree_begin, "the grid");
    const LargeBytes memory = large_bytes(size);
    file.read(memory.get(), size, "the grid");

    const std::string_view bytes(memory.get(), size);
    ByteCursor tree(where, bytes, grid.tree_begin);
    counts = walk_tree(tree, grid);
    if (tree.left() > 0) tree.complain("its voxels end before the grid does");
    check_tree(counts, size, where);
    return decode_tree(bytes, grid, counts, directory.file_version, where, component);
}

SparseVolume cleaned_volume(DecodedTree tree, const VdbGridEntry& grid, const ByteCursor& file, VdbReadReport& report) {
    SparseVolume volume;
    VdbReadReport own;
    volume.name = grid.name, volume.index_to_world = grid.index_to_world;
    make_fog(std::move(tree), volume, own, label(file, grid));
    report.non_finite += own.non_finite, report.negative += own.negative;
    report.background = own.background, report.empty = own.empty;
    return volume;
}
}

// The OpenVDB library behind two functions: bytes of a tree to plain leaves and tiles, and a volume to the bytes of a
// file.
#pragma once
#include "volume/vdb/leaves.h"
#include "volume/vdb/prewalk.h"
#include "volume/vdb/vdb.h"

#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// A tree as stored: nothing cleaned, values of double trees rounded to float; of vectors one component.
struct DecodedTree {
    Leaves leaves;
    std::vector<VoxelMask> active; // of the leaves
    std::vector<Tile> active_tiles;
    std::vector<Tile> inactive_tiles; // those whose value is not 0
    std::vector<ivec3> root_nodes;    // lower corners of the 4096³ cells that are not plain background
    float background = 0;
};

// Decodes what walk_tree() has accepted and counted. Throws Error (refused, out_of_memory) naming `where`.
DecodedTree decode_tree(std::string_view bytes, const VdbGridEntry& grid, const VdbTreeCounts& counts,
                        uint32_t file_version, const std::string& where, int component = 0);

// The bytes of a file, in order: for each grid what stands before the values of its leaves, and those.
struct EncodedFog {
    std::vector<std::string> heads; // the first begins with that of the file
    EncodedLeaves leaves;

    std::vector<std::string_view> pieces() const;
    uint64_t voxels() const; // active, in leaves of one grid
};

// Throws Error (out_of_memory).
EncodedFog encode_fog(const VdbContent& content, const VdbWriteOptions& options, const std::string& where);
}

// The OpenVDB library behind two functions: decodes the bytes of a tree to plain leaves and tiles, and encodes a volume
// to the bytes of a file.
#pragma once
#include "volume/vdb/file/prewalk.h"
#include "volume/vdb/library/leaves.h"
#include "volume/vdb/vdb.h"

#include <string>
#include <string_view>
#include <vector>

namespace tyndall {
// A tree as stored, without cleaning: doubles rounded to float, one component of vectors.
struct DecodedTree {
    Leaves leaves;
    std::vector<VoxelMask> active; // per leaf
    std::vector<Tile> active_tiles;
    std::vector<Tile> inactive_tiles; // those in the box of the active voxels that are not 0, equal ones along z as one
    std::vector<ivec3> root_nodes;    // lower corners of the 4096³ cells that the file mentions
    float background = 0;
};

// Decodes a tree that walk_tree() has checked and counted, and counts its inactive tiles. Throws Error (refused,
// out_of_memory) naming `where`.
DecodedTree decode_tree(std::string_view bytes, const VdbGridEntry& grid, VdbTreeCounts& counts, uint32_t file_version,
                        const std::string& where, int component = 0);

// The bytes of a file, in order: for each grid everything before its leaf values, then the values.
struct EncodedFog {
    std::vector<std::string> heads; // the first begins with the file header
    EncodedLeaves leaves;

    std::vector<std::string_view> pieces() const;
    uint64_t voxels() const; // active voxels in the leaves of one grid
};

// Throws Error (out_of_memory).
EncodedFog encode_fog(const VdbContent& content, const VdbWriteOptions& options, const std::string& where);
}

// The OpenVDB library behind two functions: bytes of a tree to plain leaves and tiles, and a volume to the bytes of a
// file.
#pragma once
#include "volume/vdb.h"
#include "volume/vdb_prewalk.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall {
using VoxelMask = std::array<uint64_t, 8>; // bit x·64 + y·8 + z

// A tree as stored: nothing cleaned, values of double trees rounded to float.
struct DecodedTree {
    std::vector<Leaf> leaves;
    std::vector<VoxelMask> active; // of the leaves
    std::vector<Tile> active_tiles;
    std::vector<Tile> inactive_tiles; // those whose value is not 0
    std::vector<ivec3> root_nodes;    // lower corners of the 4096³ cells that are not plain background
    float background = 0;
};

// Decodes what walk_tree() has accepted. Throws Error (refused, out_of_memory) naming `where`.
DecodedTree decode_tree(std::string bytes, const VdbGridEntry& grid, uint32_t file_version, const std::string& where);

// The bytes of a file with one fog grid. Throws Error (out_of_memory).
std::string encode_fog(const SparseVolume& volume, const VdbWriteOptions& options, const std::string& where);
}

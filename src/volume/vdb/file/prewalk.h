// Validates the structure of an OpenVDB file with plain reads before the library sees it, because the library trusts
// every length and count. Nothing is allocated on the basis of sizes the file merely claims; errors in malformed or
// truncated files name the location.
#pragma once
#include "base/math.h"
#include "volume/vdb/file/bytes.h"

#include <string>
#include <utility>
#include <vector>

namespace tyndall {
using VdbMetadata = std::vector<std::pair<std::string, std::string>>; // values as text

// A grid as its descriptor, metadata and transform describe it.
struct VdbGridEntry {
    std::string name;                   // without the suffix that distinguishes grids of the same name
    std::string unique_name, parent;    // `parent` is the unique name of the grid whose tree an instance shares
    std::string type, tree_shape;       // "float" and "5_4_3"
    std::string grid_class = "unknown"; // "fog volume", "level set", "staggered"
    bool half = false;                  // floating-point values are stored as 16 bits
    uint32_t compression = 0;           // bits of VdbCompression
    VdbMetadata metadata;
    dmat4 index_to_world{1};
    ivec3 stated_low{0}, stated_high{-1};  // box of the active voxels, as the file states it; empty if it does not
    std::string transform_problem;         // why index_to_world is unusable; empty if valid
    uint64_t tree_begin = 0, tree_end = 0; // bytes of topology and voxels (of the parent, for an instance)
    uint32_t nano_type = 0;                // NanoVDB grid type; 0 = OpenVDB grid
    uint64_t nano_bytes = 0;               // decompressed size of a NanoVDB grid
};

enum VdbCompression : uint32_t { vdb_zip = 1, vdb_active_mask = 2, vdb_blosc = 4 };
std::string compression_name(uint32_t flags);

struct VdbDirectory {
    bool nano = false; // a NanoVDB file, which has no file version
    uint32_t file_version = 0, library_major = 0, library_minor = 0;
    VdbMetadata metadata;
    std::vector<VdbGridEntry> grids; // in file order; none before a simulation emits anything
};

// Reads the header, metadata and every grid's description. Throws Error (refused) unless the file is a complete OpenVDB
// or NanoVDB file.
VdbDirectory read_directory(ByteCursor& file);

struct VdbTreeCounts {
    uint64_t leaves = 0, lower_nodes = 0, upper_nodes = 0, root_tiles = 0;
    uint64_t active_tiles = 0, active_voxels = 0; // including the voxels of active tiles
    uint64_t inactive_tiles = 0;                  // those that are decoded; 0 until then
    std::vector<uint64_t> leaf_begins;            // offset of each leaf's values from the start of the tree
};

// True for grid types that walk_tree() can read, for those with one float or double per voxel, and with three.
bool is_walkable(const VdbGridEntry& grid);
bool is_scalar_float(const VdbGridEntry& grid);
bool is_vector_float(const VdbGridEntry& grid);

// Checks topology, voxel masks and every chunk of values from the cursor's position to the end of the tree.
// Refuses root nodes farther than 2^24 voxels from the origin.
VdbTreeCounts walk_tree(ByteCursor& bytes, const VdbGridEntry& grid);

inline constexpr int largest_coordinate = 1 << 24;
}

// The structure of an OpenVDB file, walked with plain reads before the library sees it: the library trusts every length
// and count it finds. Nothing is allocated that the file only announces; what is malformed or cut is refused by place.
#pragma once
#include "base/math.h"
#include "volume/vdb/bytes.h"

#include <string>
#include <utility>
#include <vector>

namespace tyndall {
using VdbMetadata = std::vector<std::pair<std::string, std::string>>; // values as text

// A grid as its descriptor, metadata and transform describe it.
struct VdbGridEntry {
    std::string name;                   // without the suffix that tells grids of one name apart
    std::string unique_name, parent;    // `parent` is the unique name of the grid whose tree an instance shares
    std::string type, tree_shape;       // "float" and "5_4_3"
    std::string grid_class = "unknown"; // "fog volume", "level set", "staggered"
    bool half = false;                  // floating point values are stored as 16 bits
    uint32_t compression = 0;           // bits of VdbCompression
    VdbMetadata metadata;
    dmat4 index_to_world{1};
    std::string transform_problem;         // why index_to_world is of no use; empty when it is good
    uint64_t tree_begin = 0, tree_end = 0; // bytes of topology and voxels (of the parent, for an instance)
    uint32_t nano_type = 0;                // how NanoVDB stores the values; 0 = a grid of an OpenVDB file
    uint64_t nano_bytes = 0;               // of such a grid when unpacked
};

enum VdbCompression : uint32_t { vdb_zip = 1, vdb_active_mask = 2, vdb_blosc = 4 };
std::string compression_name(uint32_t flags);

struct VdbDirectory {
    bool nano = false; // a NanoVDB file, which has no version beside its library's
    uint32_t file_version = 0, library_major = 0, library_minor = 0;
    VdbMetadata metadata;
    std::vector<VdbGridEntry> grids; // in file order, at least one
};

// Header, metadata and every grid's description. Throws Error (refused) for what is neither a whole OpenVDB file nor a
// whole NanoVDB file.
VdbDirectory read_directory(ByteCursor& file);

struct VdbTreeCounts {
    uint64_t leaves = 0, lower_nodes = 0, upper_nodes = 0, root_tiles = 0;
    uint64_t active_tiles = 0, active_voxels = 0; // the voxels of active tiles included
    std::vector<uint64_t> leaf_begins;            // where the values of each leaf begin, from the start of the tree
};

// Grid types whose trees walk_tree can read, those that hold one number per voxel, and those that hold three.
bool is_walkable(const VdbGridEntry& grid);
bool is_scalar_float(const VdbGridEntry& grid);
bool is_vector_float(const VdbGridEntry& grid);

// Checks topology, voxel masks and every chunk of values from the cursor's position to the end of the tree.
// Root nodes further than 2^24 voxels from the origin are refused.
VdbTreeCounts walk_tree(ByteCursor& bytes, const VdbGridEntry& grid);

inline constexpr int largest_coordinate = 1 << 24;
}

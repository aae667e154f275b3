// The values of leaves as a file holds them: a mask, what inactive voxels are, a compressed chunk of the active ones.
// The library codes one leaf at a time; here many are coded in parallel, to the same bytes.
#pragma once
#include "volume/bricks/voxel_mask.h"
#include "volume/vdb/vdb.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tyndall {
// The value a reader will see: what half cannot hold is clamped, what it rounds to nothing is nothing.
float stored_value(float value, bool half);

// The values of one grid.
struct EncodedValues {
    std::vector<std::string_view> pieces; // bytes of the leaves with active voxels, in order; they live in `memory`
    std::unique_ptr<char[]> memory;
};

struct EncodedLeaves {
    std::vector<VoxelMask> masks; // active voxels, of every leaf asked for
    std::vector<EncodedValues> grids;
};

// Encodes `count` leaves of each grid, filled when their turn comes, on several threads. `compression` is one of
// vdb_zip and vdb_blosc; inactive voxels are 0. The same bytes at any thread count.
EncodedLeaves encode_leaves(size_t count, std::span<const VdbGridContent> grids, const LeafFill& fill, bool half,
                            uint32_t compression);

// How a file holds the leaves of a tree of floats, doubles or three of them, and which of the three is wanted.
enum class LeafValue { single, wide, three_single, three_wide };
struct LeafCoding {
    uint32_t file_version = 0, compression = 0;
    bool half = false;
    LeafValue value = LeafValue::single;
    int component = 0;
    dvec3 background{0}; // of numbers the first
};

// Decodes the leaf that begins at each position into the leaf and the mask of that number; origins stay. Throws when
// its bytes are not a leaf's, or not all of them up to the next.
void decode_leaves(std::string_view bytes, std::span<const uint64_t> begins, const LeafCoding& coding,
                   std::span<Leaf> leaves, std::span<VoxelMask> active);
}

// Leaf values in the file format: a mask, a flag for inactive values, and a compressed chunk of the active ones. The
// library codes one leaf at a time; here many are coded in parallel, to the same bytes.
#pragma once
#include "volume/bricks/voxel_mask.h"
#include "volume/vdb/vdb.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tyndall {
// The value as a reader will see it: clamped to the range of the format and rounded; negative values become 0.
float stored_value(float value, bool half);

// The values of one grid.
struct EncodedValues {
    std::vector<std::string_view> pieces; // bytes of the leaves with active voxels, in order; point into `memory`
    std::unique_ptr<char[]> memory;
};

struct EncodedLeaves {
    std::vector<VoxelMask> masks; // active voxels of every requested leaf
    std::vector<EncodedValues> grids;
};

// Encodes `count` leaves of each grid on several threads, calling `fill` for each leaf when needed. `compression` is
// vdb_zip or vdb_blosc; inactive voxels are 0. The bytes do not depend on the thread count.
EncodedLeaves encode_leaves(size_t count, std::span<const VdbGridContent> grids, const LeafFill& fill, bool half,
                            uint32_t compression);

// Storage of the leaves of a tree of floats, doubles or 3-vectors of them, and the component to decode.
enum class LeafValue { single, wide, three_single, three_wide };
struct LeafCoding {
    uint32_t file_version = 0, compression = 0;
    bool half = false;
    LeafValue value = LeafValue::single;
    int component = 0;
    dvec3 background{0}; // scalars use the first component
};

// Decodes the leaf at begins[n] into leaves[n] and active[n]; origins are kept. Throws if the bytes are not a valid
// leaf or do not end where the next begins.
void decode_leaves(std::string_view bytes, std::span<const uint64_t> begins, const LeafCoding& coding,
                   std::span<Leaf> leaves, std::span<VoxelMask> active);
}

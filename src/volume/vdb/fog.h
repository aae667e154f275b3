// From a tree as stored to fog: values cleaned, and nothing outside the box of the active voxels.
#pragma once
#include "volume/vdb/codec.h"

namespace tyndall {
// Box of the active voxels and tiles, both corners included; high < low when there are none.
struct ActiveBox {
    ivec3 low{0}, high{-1};

    bool empty() const { return high.x < low.x; }
};
ActiveBox active_box(const DecodedTree& tree);

// Fills leaves, tiles and active box of `volume`. Counts what was mended in `report`.
// Inactive values inside the active box are kept. Throws Error (refused) naming `where`.
void make_fog(DecodedTree tree, SparseVolume& volume, VdbReadReport& report, const std::string& where);

// Maps every value of active voxels, and of others that are not 0 or belong to a level set.
void apply(const ValueMap& map, DecodedTree& tree);

// Sets values above `most` to it and counts those of active voxels.
void limit(DecodedTree& tree, float most, VdbReadReport& report);

// Sets what is not active to 0.
void keep_active(DecodedTree& tree);

// Sets voxels whose value is not finite to 0, and counts those that are active.
void keep_finite(DecodedTree& tree, VdbReadReport& report);

// Active voxels as they are, of either sign.
void make_plain(DecodedTree tree, SparseVolume& volume);

// 1 at active voxels, 0 elsewhere.
DecodedTree active_share(DecodedTree tree);

// Minimum, maximum and mean of the finite active values, and how many are not finite or negative.
void add_statistics(const DecodedTree& tree, VdbGridInfo& info);
}

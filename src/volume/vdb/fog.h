// Turns a stored tree into fog: cleans values and clears everything outside the box of the active voxels.
#pragma once
#include "volume/vdb/library/codec.h"

namespace tyndall {
// Box of the active voxels and tiles, inclusive; high < low if there are none.
struct ActiveBox {
    ivec3 low{0}, high{-1};

    bool empty() const { return high.x < low.x; }
    // Whether a tile that is not active belongs to the fog: it is not 0 and not outside the box altogether.
    bool takes(const Tile& tile) const {
        return tile.value != 0 && !empty() && glm::all(glm::lessThanEqual(tile.low, high)) &&
               glm::all(glm::lessThanEqual(low, tile.high));
    }
};
ActiveBox active_box(const DecodedTree& tree);

// Fills leaves, tiles and active box of `volume`, and counts corrected values in `report`. Inactive values inside the
// active box are kept. Throws Error (refused) naming `where`.
void make_fog(DecodedTree tree, SparseVolume& volume, VdbReadReport& report, const std::string& where);

// Maps the values of active voxels, and of inactive ones that are nonzero or belong to a level set.
void apply(const ValueMap& map, DecodedTree& tree);

// Clamps values to `most` and counts the affected active voxels.
void limit(DecodedTree& tree, float most, VdbReadReport& report);

// Sets inactive values to 0.
void keep_active(DecodedTree& tree);

// Sets nonfinite values to 0 and counts those of active voxels.
void keep_finite(DecodedTree& tree, VdbReadReport& report);

// Keeps active voxels unchanged, including negative values.
void make_plain(DecodedTree tree, SparseVolume& volume);

// 1 at active voxels, 0 elsewhere.
DecodedTree active_mask(DecodedTree tree);

// Minimum, maximum and mean of the finite active values, and the number of nonfinite and negative ones.
void add_statistics(const DecodedTree& tree, VdbGridInfo& info);
}

// The voxels that are active in any of several grids.
#pragma once
#include "volume/vdb/library/codec.h"

namespace tyndall {
// Whether two trees have the same leaves, active voxels and active tiles.
bool same_voxels(const DecodedTree& a, const DecodedTree& b);

// Adds the active voxels of another tree to a mask of active_mask().
void unite(DecodedTree& mask, const DecodedTree& other);
}

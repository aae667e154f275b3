// The light of froxels as it was in the last frame, found again from this frame's.
#pragma once
#include "modes/froxel_still.h"

#include <span>

namespace tyndall {
// Per froxel of the last frame: its light and extinction (as FroxelLight), zeros where it was hidden, empty or not
// finite.
struct FroxelMemory {
    FroxelGrid grid;
    FroxelLight light;
    FroxelStill still;
};

FroxelMemory memory_of(const FroxelGrid& grid, const FroxelTiles& tiles, FroxelLight light, FroxelStill still = {});

// The light and extinction remembered at the centre of each froxel of `grid`; zeros where the last frame did not see
// it.
FroxelLight recall(const FroxelMemory& memory, const FroxelGrid& grid, const FroxelTiles& tiles);

// 1 for each froxel that need not be lit anew in this frame: all remembered ones but a quarter, another one each frame,
// and but those near a local light, whose peak their neighbours do not show.
std::vector<uint8_t> stale_froxels(const FroxelGrid& grid, const FroxelLight& remembered, std::span<const Light> lights,
                                   int frame);

// This frame's light and extinction blended with what is remembered, weighted `weight`, after clamping it to what the
// froxels around show in this frame. Stale froxels (may be null) are what they were, within those bounds.
FroxelLight blend_history(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& remembered,
                          const uint8_t* stale, float weight, const FroxelLight& light);
}

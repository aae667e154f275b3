// Temporal history of froxel light: the last frame's froxels, resampled at this frame's and blended with them.
#pragma once
#include "modes/froxel/lookup/integrate.h"
#include "modes/froxel/statics.h"
#include "volume/medium.h"

#include <span>

namespace tyndall {
// Per froxel of the last frame: its light and extinction (as FroxelLight), zeros where it was hidden, empty or not
// finite.
struct FroxelHistory {
    FroxelGrid grid;
    FroxelLight light;
    FroxelStatics statics;
};

// Zeroes froxels that are hidden, empty or not finite, as a history wants them.
void clear_invalid(const FroxelGrid& grid, const FroxelTiles& tiles, FroxelLight& light);

// The history's light and extinction at the center of each of this frame's froxels; zeros where the last frame did not
// see it.
struct Reprojection {
    FroxelLight light;
    // Per tile: variance that interpolation between froxels adds, froxels², summed over the three axes, mean of its
    // froxels. Empty if froxels coincide with those of the last frame.
    std::vector<float> blur;
};
Reprojection reproject(const FroxelHistory& memory, const FroxelGrid& grid, const FroxelTiles& tiles);

// 1 for each froxel that need not be relit in this frame: all with a history, except a quarter that alternates from
// frame to frame, and those near a local light, whose peak their neighbors do not show. With `statics` (static fog),
// froxels without fog are stale too.
std::vector<uint8_t> stale_froxels(const FroxelGrid& grid, const FroxelLight& remembered, std::span<const Light> lights,
                                   int frame, bool statics = false);

struct BlendPass {
    float weight = 0;               // of the history, where it is not blurred
    float view_depth = 1;           // factor on optical depths in the sums
    const uint8_t* stale = nullptr; // per froxel, 1 = not relit: keeps its history
    bool statics = false;           // stale froxels keep their extinction too; else all extinction is new
    std::span<const float> blur{};  // per tile, as in Reprojection
};

// Clamps the history in `light` to each froxel's neighborhood in this frame, blends it with this frame's light and
// extinction, and returns the integrated sums. `light` is then the history of the next frame.
FroxelSums blend_history(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& now,
                         const BlendPass& pass, FroxelLight& light);
}

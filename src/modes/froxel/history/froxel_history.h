// The light of froxels as it was in the last frame, found again from this frame's.
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

// Frees light from what is not known.
void clean(const FroxelGrid& grid, const FroxelTiles& tiles, FroxelLight& light);
FroxelHistory memory_of(const FroxelGrid& grid, const FroxelTiles& tiles, FroxelLight light,
                        FroxelStatics statics = {});

// The light and extinction remembered at the centre of each froxel of a frame; zeros where the last one did not see it.
struct Reprojection {
    FroxelLight light;
    // Of each tile, froxels²: how much wider finding it between remembered froxels made what it shows, summed over the
    // three directions, mean of its froxels. Empty where every froxel is where one was.
    std::vector<float> blur;
};
Reprojection reproject(const FroxelHistory& memory, const FroxelGrid& grid, const FroxelTiles& tiles);

// 1 for each froxel that need not be lit anew in this frame: all remembered ones but a quarter, another one each frame,
// and but those near a local light, whose peak their neighbours do not show. In `still` fog also those without fog.
std::vector<uint8_t> stale_froxels(const FroxelGrid& grid, const FroxelLight& remembered, std::span<const Light> lights,
                                   int frame, bool statics = false);

struct BlendPass {
    float weight = 0;               // of what is remembered, where it is not blurred
    float view_depth = 1;           // of the sums
    const uint8_t* stale = nullptr; // per froxel, 1 = it is what it was
    bool statics = false;           // its extinction too; else that is new everywhere
    std::span<const float> blur{};  // per tile, as Reprojection
};

// Blends what `light` remembers, after clamping it to what the froxels around show in this frame, with this frame's
// light and extinction. `light` is then what the next frame is to remember.
FroxelSums blend_history(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& now,
                         const BlendPass& pass, FroxelLight& light);
}

// Settings of froxel.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Rung;

enum class FroxelVisibility { off, rays, intervals };
enum class FroxelLookup { trilinear, tricubic, jittered };

struct FroxelSettings {
    int tile = 8; // pixels, in large images: see with_tile()
    int depth_slices = 64;
    float depth_growth = 4; // thickness of the last slice over that of the first
    FroxelVisibility visibility = FroxelVisibility::intervals;
    int shadow_rays = 1; // per froxel and frame
    FroxelLookup lookup = FroxelLookup::trilinear;
    float history = 0.9f; // weight of earlier frames
    bool amortize = false;
};

// With the tile for an image of `size` pixels: smaller in small ones, in which froxels would be wider than the shafts,
// and for which there is time for more of them.
FroxelSettings with_tile(FroxelSettings settings, ivec2 size);

// For the mode's row of the table.
void append_froxel_rows(std::vector<SettingRow>& rows);
void set_froxel_quality(Settings& settings, Quality quality);
std::vector<Rung> froxel_rungs();
}

// A light on the lines of a froxel, exactly: how much of it arrives at each slice, and where.
#pragma once
#include "modes/froxel_fill.h"

namespace tyndall {
// What arrives of a light at a froxel: a factor on its intensity, and the point the light is best asked for at.
struct FroxelArrival {
    float amount = 0;
    vec3 point{0};
};

// Of up to 16 tiles and one of each tile's rays, up to the surface that it meets.
struct FroxelLit {
    std::vector<FroxelArrival> arrivals; // [(lane · lights + light) · slices + slice]
    size_t lights = 0, slices = 0;
    const FroxelArrival& at(size_t lane, size_t light, int slice) const {
        return arrivals[(lane * lights + light) * slices + static_cast<size_t>(slice)];
    }
};

// The lit stretches of the lines, integrated with the light's strength along them; of a spot, on all rays of each tile.
// Each line sees one point of a soft light, picked by `indices` (one per lane; null: its centre). Tiles outside the
// grid are left out.
FroxelLit find_froxel_lit(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles,
                          const ivec2* lanes, size_t ray, const uint32_t* indices);

// Sixteen points spread over a froxel that is large beside its distance from a local light, dense towards the light
// and each with a shadow ray: what they receive on average.
FroxelArrival near_arrival(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, ivec2 at,
                           int slice, size_t light, uint32_t index);
}

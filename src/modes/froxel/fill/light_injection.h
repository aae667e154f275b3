// Exact light along the lines of froxels: how much of it arrives in each slice, and where.
#pragma once
#include "modes/froxel/fill/fill.h"

namespace tyndall {
// Light that arrives in a froxel: a factor on the light's intensity, and the point at which the light is best
// evaluated.
struct FroxelLightSample {
    float amount = 0;
    vec3 point{0};
};

// For up to 16 tiles (lanes), along one ray of each, up to the surface it hits.
struct LightInjection {
    // For a sun: ∫ dz and ∫ z dz over the lit segments of a slice, in planar depth.
    struct Depths {
        alignas(64) float length[16] = {};
        alignas(64) float first[16] = {};
    };
    // For other lights: as FroxelLightSample.
    struct Arrivals {
        alignas(64) float amount[16] = {};
        alignas(64) float point[3][16] = {};
    };
    std::vector<Depths> depths;     // [light · slices + slice]
    std::vector<Arrivals> arrivals; // likewise
};

// Finds the lit segments of the lines and integrates each light's strength along them, for spots and filters on all
// rays of each tile. Each line sees one point of a soft light, picked by `indices` (one per lane; null: its center).
// Tiles outside the grid are skipped; the others lie in one block of 8×8 tiles, aligned to multiples of 8.
void find_froxel_lit(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, const ivec2* lanes,
                     size_t ray, const uint32_t* indices, LightInjection& lit);

// Finds, per slice, the length of one ray of each tile inside a beam, and of its lit part; `indices` as above.
void find_beam_lengths(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, size_t light,
                       const ivec2* lanes, size_t ray, const uint32_t* indices, const FroxelBeams::Reach* reaches,
                       LightInjection::Depths* inside, LightInjection::Depths* lit);

// Mean light at 16 points of a froxel that is large relative to its distance from a local light; points are denser
// towards the light, and each traces a shadow ray.
FroxelLightSample near_arrival(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, ivec2 at,
                               int slice, size_t light, uint32_t index);
}

// A light on the lines of a froxel, exactly: how much of it arrives at each slice, and where.
#pragma once
#include "modes/froxel/fill/fill.h"

namespace tyndall {
// What arrives of a light at a froxel: a factor on its intensity, and the point the light is best asked for at.
struct FroxelLightSample {
    float amount = 0;
    vec3 point{0};
};

// Of up to 16 tiles (lanes) and one of each tile's rays, up to the surface that it meets.
struct LightInjection {
    // Of a sun: the lit stretches of a slice in planar depth, ∫ dz and ∫ z dz over them.
    struct Depths {
        alignas(64) float length[16] = {};
        alignas(64) float first[16] = {};
    };
    // Of other lights: as FroxelLightSample.
    struct Arrivals {
        alignas(64) float amount[16] = {};
        alignas(64) float point[3][16] = {};
    };
    std::vector<Depths> depths;     // [light · slices + slice]
    std::vector<Arrivals> arrivals; // likewise
};

// The lit stretches of the lines, integrated with the light's strength along them; of a spot, on all rays of each tile.
// Each line sees one point of a soft light, picked by `indices` (one per lane; null: its centre). Tiles outside the
// grid are left out; the others lie within 8×8 tiles whose corner is a multiple of 8.
void find_froxel_lit(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, const ivec2* lanes,
                     size_t ray, const uint32_t* indices, LightInjection& lit);

// The stretches in a beam of one ray of each tile that it reaches, and what of them is lit, by slices; `indices` as
// above.
void find_beam_lit(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, size_t light,
                   const ivec2* lanes, size_t ray, const uint32_t* indices, const FroxelBeams::Reach* reaches,
                   LightInjection::Depths* inside, LightInjection::Depths* lit);

// Sixteen points spread over a froxel that is large beside its distance from a local light, dense towards the light
// and each with a shadow ray: what they receive on average.
FroxelLightSample near_arrival(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, ivec2 at,
                               int slice, size_t light, uint32_t index);
}

// Fog along camera rays, interpolated from integrated froxels.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/froxel/lookup/integrate.h"
#include "modes/froxel/settings.h"

namespace tyndall {
struct FroxelBuffer {
    FroxelGrid grid;
    FroxelTiles tiles;
    FroxelSums sums;
    FroxelLookup lookup = FroxelLookup::trilinear;
    float view_depth = 1;
    FroxelBeams beams;
    const FroxelScene* scene = nullptr; // of the beams; null without any
};

// Radiance, transmittance and validity of up to 16 rays of the grid's camera. `parts` are further sums over the same
// froxels: their light goes to `of_parts`, rays × parts; that of the beams to `of_beams`, rays × beams.
void look_up_froxels(const FroxelBuffer& froxels, const RayBatch& batch, std::span<Scatter> results,
                     std::span<const FroxelSums> parts = {}, std::span<vec3> of_parts = {},
                     std::span<vec3> of_beams = {});
}

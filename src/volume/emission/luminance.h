// Per-voxel luminance and mean color of grids that emit or color light.
#pragma once
#include "volume/emission/emission_field.h"

#include <span>
#include <string>

namespace tyndall {
// Bricks with their index-to-world transform.
struct PlacedBricks {
    std::shared_ptr<const BrickPool> bricks; // null = none
    dmat4 index_to_world{1};
    float unit = 1; // what a 1 in them stands for
};

struct LuminanceBricks {
    std::shared_ptr<const BrickPool> bricks; // emitted luminance, normalized to a maximum of 1; null = no emission
    vec3 radiance{0};                        // mean emission where the bricks are 1
    float spread = 0, out_of_gamut = 0;      // as in EmissionField
};

// Evaluates a field on the voxels of its source grids, which share the transform of the first. Throws Error like
// make_bricks().
LuminanceBricks luminance_bricks(const EmissionField& field, const dmat4& index_to_world, const std::string& name);

// Density-weighted mean of the albedo factor, and its mean relative deviation from that.
struct MeanFactor {
    vec3 mean{1};
    float spread = 0;
};
MeanFactor mean_factor(const AlbedoField& field, const PlacedBricks& density);
}

// What grids say of light, voxel by voxel: how bright and of what color on the whole.
#pragma once
#include "volume/emission/emission_field.h"

#include <span>
#include <string>

namespace tyndall {
// Bricks and where their index space lies.
struct PlacedBricks {
    std::shared_ptr<const BrickPool> bricks; // null = none
    dmat4 index_to_world{1};
};

struct LuminanceBricks {
    std::shared_ptr<const BrickPool> bricks; // luminance of what is emitted, its maximum 1; null = nothing is
    vec3 radiance{0};                        // mean colour where they are 1
    float spread = 0, out_of_gamut = 0;      // as in EmissionField
};

// Of a field on the voxels of its source, whose grids share the transform of the first. Throws Error as make_bricks().
LuminanceBricks luminance_bricks(const EmissionField& field, const dmat4& index_to_world, const std::string& name);

// Mean of the factors over the density that they color, and by what share of it they differ from that.
struct MeanFactor {
    vec3 mean{1};
    float spread = 0;
};
MeanFactor mean_factor(const AlbedoField& field, const PlacedBricks& density);
}

// Spatially varying emission and albedo, evaluated from grids at a point.
#pragma once
#include "base/math.h"

#include <array>
#include <memory>

namespace tyndall {
struct BrickPool;
class BlackbodyTable;

// A spatially varying factor on a medium's albedo: interpolated between voxels that have a color, 1 elsewhere.
struct AlbedoField {
    std::array<std::shared_ptr<const BrickPool>, 3> color; // times `coverage`; one pool three times for a gray grid
    std::shared_ptr<const BrickPool> coverage;             // 1 at voxels that have a color
    float spread = 0; // mean deviation of the factor from its mean, as a share of the scattered light
};
vec3 albedo_factor(const AlbedoField& field, vec3 point);

// Emission per meter, independent of the medium's density and before Emission::scale: color × `strength` × `absorber` ×
// (1 - albedo). The bricks of the medium itself hold relative luminance for finding and importance-sampling the light.
struct EmissionField {
    std::shared_ptr<const BlackbodyTable> table;            // maps kelvin in source[0] to a color; null: ...
    std::array<std::shared_ptr<const BrickPool>, 3> source; // ... red, green, blue; one pool three times for gray
    std::shared_ptr<const BrickPool> strength;              // flame; null = 1
    std::shared_ptr<const BrickPool> absorber;              // density of fog that emits as it absorbs; null = 1
    std::shared_ptr<const AlbedoField> albedo; // of that fog, which emits only 1 - albedo; null = in the scale
    vec3 base_albedo{0};                       // that the factors of `albedo` multiply
    float spread = 0;                          // mean deviation of the color from its mean, as a share of the light
    float out_of_gamut = 0;                    // share of the light from temperatures too red for the Rec.709 gamut
};
vec3 emission_at(const EmissionField& field, vec3 point);
}

// Fog whose emission or albedo differs from point to point: functions of grids, sampled where they are asked for.
#pragma once
#include "base/math.h"

#include <array>
#include <memory>

namespace tyndall {
struct BrickPool;
class BlackbodyTable;

// Factors on a medium's albedo. Between voxels that have a colour it is interpolated; where none is near it is 1.
struct AlbedoField {
    std::array<std::shared_ptr<const BrickPool>, 3> color; // times `there`; the same pool thrice for a grey grid
    std::shared_ptr<const BrickPool> there;                // 1 at voxels that have a colour
    float spread = 0; // share of scattered light by which colours differ from their mean, which Optics::albedo holds
};
vec3 albedo_factor(const AlbedoField& field, vec3 point);

// What fog emits per metre whatever its density, before Emission::scale: a colour × `strength` × `absorber` × what
// `albedo` leaves. Of its medium the bricks hold the luminance in proportion: where to look, and how bright.
struct EmissionField {
    std::shared_ptr<const BlackbodyTable> table;            // gives the colour of the kelvin in source[0]; null: ...
    std::array<std::shared_ptr<const BrickPool>, 3> source; // ... red, green and blue; one pool thrice for a grey grid
    std::shared_ptr<const BrickPool> strength;              // flame; null = 1
    std::shared_ptr<const BrickPool> absorber;              // density of the fog that emits as it absorbs; null = 1
    std::shared_ptr<const AlbedoField>
        albedo;          // of that fog, whose share of the light is not emitted; null = in the scale
    vec3 base_albedo{0}; // that the field's factors are of
    float spread = 0;    // share of the light by which colours differ from their mean, which Emission::radiance holds
    float out_of_gamut = 0; // share of the light that Rec.709 cannot show as red as it is
};
vec3 emission_at(const EmissionField& field, vec3 point);
}

// Limitations of froxel.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind coarse_shafts{"coarse_shafts",
                                              "shafts are no finer than froxels, about {} m wide and {} m deep here: "
                                              "light leaks through thinner walls, and thinner gaps are lost"};
inline constexpr LimitationKind few_lamp_points{
    "few_lamp_points",
    "its soft shadows in the fog are the mean of hard ones from {n} points on it: penumbras have steps, "
    "and fog beside a surface that cuts through it is too bright or too dark"};
inline constexpr LimitationKind flat_glow{"flat_glow", "no detail in the glow within {} m of the lamp"};
inline constexpr LimitationKind deep_froxels{"deep_froxels",
                                             "froxels are up to {} optical depths deep: light is averaged within each"};
inline constexpr LimitationKind thin_medium{"thin_medium",
                                            "thinner than a froxel ({} m deep): light is averaged through it"};
inline constexpr LimitationKind lost_detail{"lost_detail",
                                            "detail finer than a froxel is lost: froxels are {} m wide, voxels {} m"};
inline constexpr LimitationKind few_far_slices{"few_far_slices", "fog behind the scene gets only a few long slices"};
inline constexpr LimitationKind coarse_glow{
    "coarse_glow", "its glow or halo in fog is {} degrees wide, and froxels are {} degrees across: it is blurred"};
inline constexpr LimitationKind coarse_alpha_shadows{
    "coarse_alpha_shadows",
    "shadows of MASK and BLEND surfaces are no finer than froxels: each froxel averages eight or more shadow rays"};
}

Limitations froxel_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

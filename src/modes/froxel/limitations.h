// How the froxel cache is off.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind coarse_shafts{
    "coarse_shafts",
    "shafts are no finer than froxels, about {} m wide and {} m deep here: thinner walls and gaps leak or vanish"};
inline constexpr LimitationKind moving_camera{
    "moving_camera", "moves: with --history shafts close to it are blurred by a third of a froxel"};
inline constexpr LimitationKind moving_light{"moving_light", "moves: with --history it leaves a trail of some frames"};
inline constexpr LimitationKind flat_glow{"flat_glow", "the light around it is even within {} m"};
inline constexpr LimitationKind deep_froxels{
    "deep_froxels", "froxels are up to {} optical depths deep: light that changes within them is evened out"};
inline constexpr LimitationKind thin_medium{"thin_medium", "thinner than a froxel, {} m deep: light is even within it"};
inline constexpr LimitationKind lost_detail{"lost_detail",
                                            "detail finer than a froxel is lost: froxels of {} m, voxels of {} m"};
inline constexpr LimitationKind few_far_slices{"few_far_slices", "fog behind the scene has a few long slices only"};
inline constexpr LimitationKind rays_for_alpha{"rays_for_alpha", "rays are used: there are MASK or BLEND surfaces"};
}

Limitations froxel_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

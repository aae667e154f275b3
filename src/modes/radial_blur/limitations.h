// Limitations of radial-blur.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind screen_space{
    "screen_space", "rays are a blur of the image: fog, distance and anything off screen have no effect on them"};
inline constexpr LimitationKind homogeneous_dimming{
    "homogeneous_dimming", "dims what is behind it as homogeneous fog of its mean density (radial_blur.fog)"};
inline constexpr LimitationKind light_off_screen{"light_off_screen", "behind the camera or far off screen: no rays"};
inline constexpr LimitationKind rays_of_the_middle{
    "rays_of_the_middle", "rays start from its position at mid-shutter; it moves {} pixels while the shutter is open"};
inline constexpr LimitationKind light_leaving_screen{"light_leaving_screen", "off screen: rays fade out"};
}

Limitations radial_blur_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

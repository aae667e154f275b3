// How radial blur is off.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind screen_space{
    "screen_space", "rays are blurred brightness, not light: fog, distance and what is off screen play no part"};
inline constexpr LimitationKind homogeneous_dimming{
    "homogeneous_dimming", "dims what is behind it as homogeneous fog of its mean density (radial_blur.fog)"};
inline constexpr LimitationKind light_off_screen{"light_off_screen", "behind the camera or far off screen: no rays"};
inline constexpr LimitationKind light_leaving_screen{"light_leaving_screen", "off screen: its rays are fading out"};
}

Limitations radial_blur_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

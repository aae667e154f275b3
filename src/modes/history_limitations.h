// Limitations of techniques with temporal history: ghosts of what has moved.
#pragma once
#include "modes/limitation.h"

#include <functional>

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind moving_camera{"moving_camera",
                                              "moving: --history blurs nearby shafts by a third of a froxel"};
inline constexpr LimitationKind moving_light{"moving_light",
                                             "moving: with --history, its light trails behind by a few frames"};
inline constexpr LimitationKind moving_shadows{
    "moving_shadows", "some are moving: with --history, their shadows in the fog trail behind by a few frames"};
inline constexpr LimitationKind moving_fog{"moving_fog", "moving: with --history, it trails behind by a few frames"};
}

// Whether a light's position or direction is animated.
bool is_moving(const Snapshot& snapshot, const Light& light);

// Reports a camera with an animated position.
void add_moving_camera(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Reports animated surfaces that shadow any light for which `counts` returns true.
void add_moving_shadows(
    const Snapshot& snapshot, Limitations& limitations,
    const std::function<bool(const Light&)>& counts = [](const Light&) { return true; });

// Reports fog that moves or changes.
void add_moving_fog(const Snapshot& snapshot, Limitations& limitations);
}

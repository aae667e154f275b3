// Where techniques that look at the frames before show what is no longer there.
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

// Whether the scene gives a light keys for where it is or shines to.
bool is_moving(const Snapshot& snapshot, const Light& light);

// Keys for where the camera is.
void add_moving_camera(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Surfaces with keys for where they are, that shadow a light, of those `counts` holds for.
void add_moving_shadows(
    const Snapshot& snapshot, Limitations& limitations,
    const std::function<bool(const Light&)>& counts = [](const Light&) { return true; });

// Fog that moves or changes.
void add_moving_fog(const Snapshot& snapshot, Limitations& limitations);
}

// How the march with shadow maps is off.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind grainy_edges{
    "grainy_edges", "shafts begin and end within one of {n} steps per ray: their edges are noisy (shadow_map.steps)"};
inline constexpr LimitationKind few_steps_for_glow{
    "few_steps_for_glow", "is in the image: {n} steps per ray are few for the light around it (shadow_map.steps)"};
}

Limitations shadow_map_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

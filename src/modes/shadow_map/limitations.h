// Limitations of shadow-map.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind grainy_edges{
    "grainy_edges", "edges of shafts are noisy: {n} steps per ray do not locate them exactly (shadow_map.steps)"};
inline constexpr LimitationKind few_steps_for_glow{
    "few_steps_for_glow", "in view: {n} steps per ray are too few for the glow around a lamp (shadow_map.steps)"};
}

Limitations shadow_map_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

// Limitations of march.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind sampled_alpha_shadows{
    "sampled_alpha_shadows", "shadows of MASK and BLEND surfaces are sampled by rays, not integrated exactly"};
inline constexpr LimitationKind sampled_shadows{"sampled_shadows",
                                                "{n} triangles: shadows are sampled by rays, not integrated exactly"};
}

Limitations march_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

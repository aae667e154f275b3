// Shadow maps as modes use them for visibility.
#pragma once
#include "modes/limitation.h"
#include "trace/shadows/cached_shadows.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind coarse_texels{
    "coarse_texels", "shadow-map texels are up to {} pixels ({} m) wide at the far end of the view: shadow edges are "
                     "no sharper, and thinner occluders and gaps can be missed"};
inline constexpr LimitationKind no_partial_shadows{
    "no_partial_shadows",
    "shadow maps hold no partial shadows: BLEND surfaces of alpha 1/2 and more block all light in "
    "the fog, others none"};
}

// One shadow map per light, with the options of `settings`.
ShadowMaps make_shadow_maps(const View& view, const Snapshot& snapshot, const Settings& settings);

// Reports the errors of shadow maps, whichever mode uses them.
void add_map_shadows(const View& view, const Snapshot& snapshot, const Settings& settings, Limitations& limitations);
}

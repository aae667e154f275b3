// Limitations of shadow-volume.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind shells{
    "shells", "shells are artistic: bright sheets where light meets shadow, not light scattered by fog"};
inline constexpr LimitationKind many_silhouette_edges{
    "many_silhouette_edges", "{n} silhouette edges: slow, as every tile of the image tests many of them"};
inline constexpr LimitationKind no_alpha_shadows{
    "no_alpha_shadows", "MASK and BLEND surfaces cast no shadow: silhouettes are those of whole triangles"};
}

Limitations shadow_volume_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

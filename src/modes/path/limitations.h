// How path tracing is off: it is not, but some paths are left out or long.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind long_paths{
    "long_paths", "unbounded and hardly absorbing: paths are very long; bounds or --orders help"};
}

Limitations path_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

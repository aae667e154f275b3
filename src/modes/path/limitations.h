// Limitations of path: it is unbiased, but paths may be cut off or very long.
#pragma once
#include "modes/limitation.h"

namespace tyndall {
struct Settings;
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind long_paths{
    "long_paths", "unbounded and barely absorbing: paths get very long; bounds or a lower --orders shorten them"};
}

Limitations path_limitations(const View& view, const Snapshot& snapshot, const Settings& settings);
}

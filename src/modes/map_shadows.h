// Shadow maps as a visibility of modes.
#pragma once
#include "trace/shadows/kept_shadows.h"

#include <vector>

namespace tyndall {
struct Limit;
struct Settings;
struct Snapshot;
struct View;

// Shadow maps of all lights, as the settings ask for them.
ShadowMaps make_shadow_maps(const View& view, const Snapshot& snapshot, const Settings& settings);

// What shadow maps make wrong, whoever looks them up.
std::vector<Limit> map_limits(const View& view, const Snapshot& snapshot, const Settings& settings);
}

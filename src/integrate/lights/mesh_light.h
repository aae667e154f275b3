// Light of glowing surfaces that fog scatters once towards the eye. Points of them are picked by area and brightness,
// and distances both evenly in the angle around such a point and in proportion to what would be seen from there, which
// share it (balance heuristic).
#pragma once
#include "integrate/lights/scatter_paths.h"

namespace tyndall {
// Of a snapshot as the settings see it; nothing where no surface glows. Points on each ray: half of those asked for.
void append_mesh_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights);
}

// Light of the environment that fog scatters once towards the eye. Distances are picked in proportion to what would be
// seen from there; directions both by the light and by the phase function, which share it (balance heuristic).
#pragma once
#include "integrate/lights/scatter_paths.h"

namespace tyndall {
// Of a snapshot as the settings see it; nothing where there is none.
void append_environment_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                              std::vector<PathLight>& lights);
}

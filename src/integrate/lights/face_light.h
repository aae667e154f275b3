// Light of rectangles, discs and balls that fog scatters once towards the eye. Distances are picked both evenly in the
// angle around the light and in proportion to what would be seen from there, which share it (balance heuristic); points
// of the face by its solid angle.
#pragma once
#include "integrate/lights/scatter_paths.h"

namespace tyndall {
// Takes the lights that are faces out of a snapshot as the settings see it. Points on each ray, for each light: a
// quarter of those asked for.
void take_faces(Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                std::vector<PathLight>& lights);
}

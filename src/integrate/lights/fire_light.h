// Light of fog that glows by grids, scattered once towards the eye by other fog. Three ways to pick a point of a ray
// and a place in the fire share it (balance heuristic): places by power with distances even in the angle around them;
// places by power with distances in proportion to what would be seen from there; and from those distances, directions
// by the phase function and places by brightness on them, which is what counts within the fire.
#pragma once
#include "integrate/lights/scatter_paths.h"

namespace tyndall {
// Of a snapshot as the settings see it, with the media that only emit in it; nothing where none glows. Points on each
// ray: a third of those asked for.
void append_fire_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights);
}

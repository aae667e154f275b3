// Lamps that stand for glowing fog where techniques know of nothing else.
#pragma once
#include "integrate/ray_batch.h"
#include "scene/light.h"
#include "trace/snapshot.h"

#include <vector>

namespace tyndall {
// Of the media of a snapshot that only emit: at most four, each in the middle of the power of its part of the fire, as
// bright as it and as large. They shine on fog alone.
std::vector<Light> fire_lamps(const Snapshot& snapshot);

// How far from such a lamp its light is off by no more than a share, metres: of a ball of its size, by the mean of
// 1/r².
double far_enough(const Light& lamp, double share);

// The snapshot with lamps for its fire behind its own lights.
Snapshot with_fire_lamps(Snapshot snapshot);

// What `scatter` finds in that snapshot, its lamps' parts as the emission's. `lights`: those of the scene.
ScatterFunction with_lamps_as_emission(size_t lights, size_t lamps, ScatterFunction scatter);
}

// Lamps that approximate emissive fog for techniques that support only lamps.
#pragma once
#include "scene/light.h"
#include "trace/snapshot.h"

#include <vector>

namespace tyndall {
// At most four lamps for the emission-only media of a snapshot, each at the power-weighted center of one part of the
// fire, with its intensity and size. They illuminate only fog.
std::vector<Light> fire_lamps(const Snapshot& snapshot);

// Distance from such a lamp, meters, beyond which its relative error is at most `share`, estimated from the mean of
// 1/r² over a ball of its size.
double far_distance(const Light& lamp, double share);

// The snapshot with lamps for its fire appended to its lights.
Snapshot with_fire_lamps(Snapshot snapshot);
}

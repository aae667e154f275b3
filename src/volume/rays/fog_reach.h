// Where along a ray there is fog to ask for.
#pragma once
#include "base/math.h"

#include <span>

namespace tyndall {
struct Medium;

// Distance beyond which the media have no effect worth computing, never infinite; 0 = no fog on this ray.
// Bounded media reach to their bounds; others to optical depth 20 (a share of 2e-9 passes) or until 1e-6 is left.
float fog_reach(std::span<const Medium> media, const Ray& ray);

// The stretch of a ray from first to last fog; empty without any, endless where a medium has no bounds.
Interval<float> fog_stretch(std::span<const Medium> media, const Ray& ray);
}

// Where along a ray the fog is.
#pragma once
#include "base/math.h"

#include <span>

namespace tyndall {
struct Medium;

// Distance beyond which the effect of the media is negligible, always finite; 0 = no fog on this ray. Bounded media
// reach to their bounds; others to optical depth 20 (transmittance 2e-9) or until the remaining optical depth is 1e-6.
float fog_reach(std::span<const Medium> media, const Ray& ray);

// The interval from the first to the last fog on a ray; empty if there is none, infinite if a medium is unbounded.
Interval<float> fog_interval(std::span<const Medium> media, const Ray& ray);
}

// Where along a ray the fog is.
#pragma once
#include "volume/medium.h"

#include <span>

namespace tyndall {
// Distance beyond which the effect of the media is negligible, always finite; 0 = no fog on this ray. Bounded media
// reach to their bounds; others to optical depth 20 (transmittance 2e-9) or until the remaining optical depth is 1e-6.
float fog_reach(std::span<const Medium> media, const Ray& ray);

// The interval from the first to the last fog on a ray; empty if there is none. Where a medium is unbounded, it ends at
// end(medium, its interval).
template<class End> Interval<float> fog_interval(std::span<const Medium> media, const Ray& ray, const End& end) {
    Interval<float> stretch{infinity, 0};
    for (const Medium& medium : media) {
        Interval<float> inside = clip(medium.world_bounds, ray.origin, ray.direction, {0, ray.t_max});
        if (inside.empty()) continue;
        if (std::isinf(inside.high)) inside.high = end(medium, inside);
        stretch.low = std::min(stretch.low, inside.low), stretch.high = std::max(stretch.high, inside.high);
    }
    return stretch.empty() ? Interval<float>{} : stretch;
}

// The same, infinite where a medium is unbounded.
Interval<float> fog_interval(std::span<const Medium> media, const Ray& ray);
}

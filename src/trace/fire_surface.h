// Light of glowing fog on Lambert surfaces.
#pragma once
#include "base/math.h"

#include <span>

namespace tyndall {
struct EmissiveBricks;
struct Snapshot;
struct SurfacePoint;

// Adds to the radiance leaving up to 16 points, as of shade_surfaces(), that of the fire, through the fog and shadowed
// by all surfaces. Each pair of numbers picks a place by power and a direction by the cosine with places by brightness
// on it, which share it (balance heuristic).
void add_fire(const EmissiveBricks& fire, const Snapshot& snapshot, std::span<const SurfacePoint> points,
              std::span<const vec2> u, std::span<vec3> radiance);
}

// Light from all around on Lambert surfaces, through the fog.
#pragma once
#include "base/math.h"

#include <span>

namespace tyndall {
struct Snapshot;
struct SurfacePoint;

// Adds to the radiance of up to 16 points what they scatter of the environment's light, by n pairs of directions for
// each: by the light and by the cosine, which share it (balance heuristic). `u`: points × n pairs of numbers.
void add_environment(const Snapshot& snapshot, std::span<const SurfacePoint> points, std::span<const vec2> u,
                     std::span<vec3> radiance);
}

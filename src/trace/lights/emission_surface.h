// Light of what glows by itself, fog and other surfaces, on Lambert surfaces.
#pragma once
#include "base/math.h"

#include <memory>
#include <span>

namespace tyndall {
struct EmissiveBricks;
struct EmissiveTriangles;
struct Snapshot;
struct SurfacePoint;

// What is aimed at.
struct Emitters {
    std::shared_ptr<const EmissiveBricks> fire;        // null = none
    std::shared_ptr<const EmissiveTriangles> surfaces; // null = none

    explicit operator bool() const { return fire || surfaces; }
};
Emitters emitters_of(const Snapshot& snapshot);

// Adds to the radiance leaving up to 16 points, as of shade_surfaces(), that of the emitters, through the fog and
// shadowed by all surfaces. Each pair of numbers picks a point of a glowing surface; and of the fire a place by power,
// and a direction by the cosine with places by brightness on it, which share it (balance heuristic).
void add_emitted_light(const Emitters& emitters, const Snapshot& snapshot, std::span<const SurfacePoint> points,
                       std::span<const vec2> u, std::span<vec3> radiance);
}

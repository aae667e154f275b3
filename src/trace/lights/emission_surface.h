// Light of emissive fog and emissive surfaces on Lambertian surfaces.
#pragma once
#include "base/math.h"

#include <memory>
#include <span>

namespace tyndall {
struct EmissiveBricks;
struct EmissiveTriangles;
struct Snapshot;
struct SurfacePoint;

// What is sampled directly.
struct Emitters {
    std::shared_ptr<const EmissiveBricks> fire;        // null = none
    std::shared_ptr<const EmissiveTriangles> surfaces; // null = none

    explicit operator bool() const { return fire || surfaces; }
};
Emitters emitters_of(const Snapshot& snapshot);

// Adds the emitters' light to the radiance leaving up to 16 points, as in shade_surfaces(): attenuated by fog and
// shadowed by surfaces. Each sample pair chooses a point on an emissive surface; and in emissive fog a point by
// power, and a cosine-distributed direction with points by brightness along it, combined by the balance heuristic.
void add_emitted_light(const Emitters& emitters, const Snapshot& snapshot, std::span<const SurfacePoint> points,
                       std::span<const vec2> u, std::span<vec3> radiance);
}

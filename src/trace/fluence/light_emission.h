// Maps a unit square to the rays that a light sends into a box. Internal to light paths.
#pragma once
#include "base/math.h"

#include <memory>
#include <vector>

namespace tyndall {
struct Environment;
struct Light;
struct Snapshot;

// Directions whose cosine with the axis is at least 1 - span.
struct DirectionCone {
    vec3 axis{0, 1, 0};
    float span = 2;

    vec3 direction(vec2 u) const; // uniformly distributed
};

struct LightSquare {
    const Light* light = nullptr;
    vec3 center{0}; // of a ball around the box
    float radius = 0;
    vec3 power{0}; // of a uniform light of this intensity over the whole square
    // Suns: the rectangle perpendicular to the axis that contains all rays into the box, and its position along the
    // axis, in front of the box.
    vec3 axis{0}, across{0}, up{0}; // orthonormal
    vec2 low{0}, high{0};
    float start = 0;
    // Local lights: the narrower of the light's own cone and that around the ball; for rectangles and discs, whose
    // points have cones of their own, from the center.
    DirectionCone cone;
    // Environment: a direction sampled by radiance, and the disc perpendicular to it that covers the box.
    std::shared_ptr<const Environment> environment; // null for other lights
    std::shared_ptr<const Light> as_light;          // its scales, shadows and links; `light` points here
    // Distant lights have two squares where surfaces reach much further than the fog: one around the fog, whose rays
    // start this many meters further back, in front of the box, and one around the box that leaves those rays out.
    float back = 0;
    std::shared_ptr<const LightSquare> left_out;
    double weight = 0; // share of the paths, relative to other squares

    // The ray at a point of the unit square; `soft` chooses a point of a soft light.
    Ray ray(vec2 place, vec2 soft) const;
    // Factor on `power` along that ray.
    vec3 share(const Ray& ray) const;
};

// Squares of all lights of the snapshot for a box, in their order, then of its environment.
std::vector<LightSquare> squares_of(const Snapshot& snapshot, const Box& reach);
}

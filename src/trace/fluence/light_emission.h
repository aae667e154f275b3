// Rays of a light into a box, as a unit square. Internal to light paths.
#pragma once
#include "base/math.h"

#include <memory>
#include <vector>

namespace tyndall {
struct Environment;
struct Light;
struct Snapshot;

struct LightSquare {
    const Light* light = nullptr;
    vec3 axis{0}, across{0}, up{0}; // orthonormal
    // Suns: the rectangle across the axis that all rays into the box pass, and a place before it along the axis.
    vec2 low{0}, high{0};
    float start = 0;
    float lowest_cosine = -1; // others: of directions, from the axis
    vec3 power{0};            // of an even light of this intensity over the whole square
    // The environment's: a direction by its light, through the disc across it that covers the box.
    std::shared_ptr<const Environment> environment; // null = a light's
    std::shared_ptr<const Light> as_light;          // what fog and surfaces make of it: `light` points there
    vec3 center{0};
    float radius = 0;

    // The ray at a place of the square with 1 = all of `power`; `soft` picks a point of a soft light.
    Ray ray(vec2 place, vec2 soft) const;
    // Share of `power` along it.
    vec3 share(const Ray& ray) const;
};

// Of every light of the snapshot, in their order, and of its environment.
std::vector<LightSquare> squares_of(const Snapshot& snapshot, const Box& reach);
}

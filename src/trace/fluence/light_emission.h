// Rays of a light into a box, as a unit square. Internal to light paths.
#pragma once
#include "base/math.h"

namespace tyndall {
struct Light;

struct LightSquare {
    const Light* light = nullptr;
    vec3 axis{0}, across{0}, up{0}; // orthonormal
    // Suns: the rectangle across the axis that all rays into the box pass, and a place before it along the axis.
    vec2 low{0}, high{0};
    float start = 0;
    float lowest_cosine = -1; // others: of directions, from the axis
    vec3 power{0};            // of an even light of this intensity over the whole square

    // The ray at a place of the square with 1 = all of `power`; `soft` picks a point of a soft light.
    Ray ray(vec2 place, vec2 soft) const;
    // Share of `power` along it.
    vec3 share(vec3 direction) const;
};

LightSquare square_of(const Light& light, const Box& reach);
}

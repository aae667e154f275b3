// One ray's slice through the triangles. For shadow_slices*.cpp.
#pragma once
#include "trace/shadow_slices.h"

namespace tyndall {
// The plane through ray and light, with the ray as its x axis and the light at y > 0. A light on the line of the ray is
// moved off it by a hair: then the plane is any that holds the ray.
struct ShadowSlice {
    dvec3 origin, x, y, normal;
    double light_x, light_y; // place of the light; of a sun its direction
    bool far;
    double x_max, per_metre; // where the ray ends; x per unit of t: directions are unit to float rounding only

    struct Point {
        double x, y;
    };
    struct Segment {
        Point a, b;
    };
};
inline ShadowSlice::Point between(ShadowSlice::Point a, ShadowSlice::Point b, double share) {
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

// Appends the segments in which the triangles between ray and light cross the plane.
void append_segments(const ShadowSlices& slices, const ShadowSlice& slice, std::vector<ShadowSlice::Segment>& segments);
}

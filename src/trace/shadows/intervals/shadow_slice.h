// One ray's slice through the triangles. Internal to trace/shadows/intervals.
#pragma once
#include "trace/shadows/intervals/shadow_slices.h"

namespace tyndall {
// The plane through a ray and its light, with the ray as x axis and the light at y > 0. A light on the line of the ray
// is moved off it by a tiny distance: the plane is then any that contains the ray.
struct ShadowSlice {
    dvec3 origin, x, y, normal;
    double light_x, light_y; // position of the light; for a sun, its direction
    bool far;
    double x_max, per_meter; // end of the ray; x per unit of t, as directions are unit only to float rounding

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

// Half spaces: x·p.x + y·p.y + z·p.z >= least. Unused ones contain everything.
struct ShadowFan {
    alignas(64) double x[8] = {}, y[8] = {}, z[8] = {}, least[8] = {};
};

// Half spaces around everything between a ray and its light: both sides of the plane itself, and within it the triangle
// that ray and light span.
ShadowFan make_fan(const ShadowSlice& slice);

// Appends the leaves that a fan overlaps, each reduced to the triangles that it overlaps.
void append_leaves(const ShadowSlices& slices, const ShadowFan& fan, std::vector<ShadowSlices::Node>& leaves);

ShadowSlice make_slice(const Ray& ray, const LightPoint& light);

// The slices of up to sixteen rays, each with its light.
struct ShadowPacket {
    alignas(64) double origin[3][16] = {}, x[3][16] = {}, y[3][16] = {}, normal[3][16] = {};
    alignas(64) double light_x[16] = {}, light_y[16] = {};
    alignas(64) double near[16] = {};   // 1 for a local light, 0 for a sun
    alignas(64) double top[16] = {};    // y at which occluders end
    alignas(64) double end[16] = {};    // x_max
    alignas(64) double meters[16] = {}; // t per unit of x
    uint32_t active = 0;                // bits
};

// Appends the intervals of the active rays that a leaf's triangles shadow, by add_shadow().
void append_shadows(const ShadowSlices& slices, const ShadowSlices::Node& leaf, const ShadowPacket& packet,
                    std::vector<Interval<double>> (&shadows)[16]);

// Adds an interval to an unordered list, merged with one of the last four if they touch.
inline void add_shadow(Interval<double> shadow, std::vector<Interval<double>>& shadows) {
    const size_t first = shadows.size() > 4 ? shadows.size() - 4 : 0;
    for (size_t i = shadows.size(); i > first; --i) {
        Interval<double>& last = shadows[i - 1];
        if (shadow.low > last.high || shadow.high < last.low) continue;
        last = {std::min(last.low, shadow.low), std::max(last.high, shadow.high)};
        return;
    }
    shadows.push_back(shadow);
}

// Appends the segments in which the triangles between ray and light cross the plane.
void append_segments(const ShadowSlices& slices, const ShadowSlice& slice, std::vector<ShadowSlice::Segment>& segments);
}

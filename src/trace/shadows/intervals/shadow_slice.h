// One ray's slice through the triangles. For shadow_slices*.cpp.
#pragma once
#include "trace/shadows/intervals/shadow_slices.h"

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

// Half spaces: x·p.x + y·p.y + z·p.z >= least. Those not used hold everything.
struct ShadowFan {
    alignas(64) double x[8] = {}, y[8] = {}, z[8] = {}, least[8] = {};
};

// What holds everything between a ray and its light: the plane itself from both sides, and in it the fan that the light
// spans with the ray.
ShadowFan make_fan(const ShadowSlice& slice);

// Appends the leaves that a fan meets, or what it meets of each.
void append_leaves(const ShadowSlices& slices, const ShadowFan& fan, std::vector<ShadowSlices::Node>& leaves);

ShadowSlice make_slice(const Ray& ray, const LightPoint& light);

// The slices of up to sixteen rays, each with its light.
struct ShadowPacket {
    alignas(64) double origin[3][16] = {}, x[3][16] = {}, y[3][16] = {}, normal[3][16] = {};
    alignas(64) double light_x[16] = {}, light_y[16] = {};
    alignas(64) double near[16] = {};   // 1 for a local light, 0 for a sun
    alignas(64) double top[16] = {};    // y at which occluders end
    alignas(64) double end[16] = {};    // x_max
    alignas(64) double metres[16] = {}; // of t per unit of x
    uint32_t active = 0;                // bits
};

// Appends what the triangles of a leaf shadow of the active rays, as add_shadow() does.
void append_shadows(const ShadowSlices& slices, const ShadowSlices::Node& leaf, const ShadowPacket& packet,
                    std::vector<Interval<double>> (&shadows)[16]);

// Adds a stretch to a list in no order, joined with one of the last where they touch.
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

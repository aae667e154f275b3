// Which light a path turns to next, and how far along a line through fog it looks for it.
#pragma once
#include "base/math.h"
#include "integrate/equi_angular.h"

#include <span>
#include <vector>

namespace tyndall {
struct Light;
struct Snapshot;
struct SurfacePoint;

// One light along a line: distances are picked even in angle around a local light, even in
// length under the sun.
struct LineLight {
    Interval<float> reach;      // of the line, where there is fog and the light can be; empty = nowhere
    EquiAngular<double> angles; // of `reach`, seen from a local light
    float chance = 0;           // of being picked among the lights

    float distance(float u) const;
    float density(float t) const; // of the distances picked, 1/m
};

// All lights along a line that ends at line.t_max, in the order of the snapshot. Chances are in proportion to the light
// that would arrive on the line without fog and shadows; all 0 when there is none.
void lights_on_line(const Snapshot& snapshot, const Ray& line, std::vector<LineLight>& lights);

// A light for a point, picked in proportion to what would arrive there without fog and shadows; chance 0 = none.
struct LightPick {
    int light = 0;
    float chance = 0;
    vec3 irradiance{0}; // volume_scale or surface_scale and cosine included
    vec3 to_light{0};
};
LightPick pick_light(const Snapshot& snapshot, vec3 point, float u);                  // in fog
LightPick pick_light(const Snapshot& snapshot, const SurfacePoint& surface, float u); // on a surface
float pick_chance(const Snapshot& snapshot, vec3 point, int light);                   // in fog
}

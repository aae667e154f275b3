// Sampling of lights for points of a path, and of distances along lines through fog.
#pragma once
#include "base/math.h"
#include "integrate/equi_angular.h"

#include <span>
#include <vector>

namespace tyndall {
struct Light;
struct Snapshot;
struct SurfacePoint;

// One light along a line: distances are sampled uniformly in angle for a local light (equi-angular), uniformly in
// length for a sun.
struct LineLight {
    Interval<float> reach;      // part of the line with fog that the light can reach; empty = none
    EquiAngular<double> angles; // of `reach`, seen from a local light
    float probability = 0;      // of picking this light

    float distance(float u) const;
    float pdf(float t) const; // of distances, 1/m
};

// All lights along a line that ends at line.t_max, in the order of the snapshot. Probabilities are proportional to the
// light that would arrive on the line without fog and shadows; all 0 if there is none.
void lights_on_line(const Snapshot& snapshot, const Ray& line, std::vector<LineLight>& lights);

// A light picked for a point, with a probability proportional to the light that would arrive there without fog and
// shadows; probability 0 = none.
struct LightPick {
    int light = 0;
    float probability = 0;
    vec3 irradiance{0}; // volume_scale or surface_scale and cosine included
    vec3 to_light{0};
};
LightPick pick_light(const Snapshot& snapshot, vec3 point, float u);                  // in fog
LightPick pick_light(const Snapshot& snapshot, const SurfacePoint& surface, float u); // on a surface
float pick_probability(const Snapshot& snapshot, vec3 point, int light);              // in fog
}

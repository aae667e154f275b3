// Paths of light the way light goes: from the lights through fog and over surfaces.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct Snapshot;

// A straight stretch of a path after its first scattering: `light` is the power it carries.
struct Flight {
    vec3 from{0}, direction{0}; // direction: unit, of travel
    float length = 0;
    vec3 light{0};
};

// Where paths go, and which flights are noted.
struct LightPathRules {
    Box reach;      // paths that leave it end
    Box noted;      // of flights the part in here
    int orders = 2; // of light that the flights make when they are scattered once more, at most
    uint32_t seed = 0;
};

// All rays of the lights into a box, as squares divided into as many strata each. `chances` of strata add up to 1.
struct RayStrata {
    int side = 1;                   // strata along each side of a light's square
    std::vector<double> cumulative; // chance of the strata up to and with each: [light·side² + stratum]
};

// Chances in proportion to the power of the lights, spread evenly over their squares.
RayStrata even_strata(const Snapshot& snapshot, const Box& reach, int side);

// Whether the snapshot has light whose paths can be followed: lights or an environment.
bool has_sources(const Snapshot& snapshot);

// What a number of paths brought.
struct LightPathResult {
    std::vector<Flight> flights;   // in the order of the paths
    int64_t first_scatterings = 0; // in fog, of light straight from lights
    double scattered_once = 0;     // power that fog scattered which came straight from lights ...
    double scattered_more = 0;     // ... and which had been scattered before, by fog or surfaces
    int64_t hits = 0;              // paths with flights that were noted
    std::vector<float> of_stratum{}; // per stratum: Σ over paths of (power · length of the flights)²; empty = not asked
};

// `count` paths of `total`, from `first` on, each `step` after the one before: all share the strata evenly, and each
// has random numbers of its own. The result adds up to an estimate of the whole when all `total` are taken.
void trace_light_paths(const Snapshot& snapshot, const RayStrata& strata, const LightPathRules& rules, int64_t first,
                       int64_t count, int64_t total, LightPathResult& result, int64_t step = 1);

// Where light paths go: fog and surfaces, and of endless fog as far beyond as its light comes back from.
Box light_reach(const Snapshot& snapshot);

// The fog within a box.
Box fog_bounds(const Snapshot& snapshot, const Box& reach);
}

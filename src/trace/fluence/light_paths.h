// Light tracing: paths from the lights through fog and off surfaces.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct Snapshot;

// A straight segment of a path after its first scattering; `light` is the power it carries.
struct PathSegment {
    vec3 from{0}, direction{0}; // direction: unit, of travel
    float length = 0;
    vec3 light{0};
};

// Limits of paths, and which segments are recorded.
struct LightPathRules {
    Box reach;      // paths that leave it end
    Box recorded;   // segments are recorded inside
    int orders = 2; // maximum scattering order, the next scattering of the segments included
    uint32_t seed = 0;
};

// All rays of the lights into a box: their squares, each divided into as many strata.
struct RayStrata {
    int side = 1;                   // strata along each side of a light's square
    std::vector<double> cumulative; // probability of the strata up to and including each: [square·side² + stratum]
};

// Probabilities by the weights of the squares (proportional to the power of the lights), uniform over each square.
RayStrata even_strata(const Snapshot& snapshot, const Box& reach, int side);

// Whether the snapshot has lights or an environment.
bool has_lights(const Snapshot& snapshot);

// Accumulated results of paths.
struct LightPathResult {
    std::vector<PathSegment> segments; // in the order of the paths
    int64_t first_scatterings = 0;     // in fog, of light straight from the lights
    double scattered_once = 0;         // power scattered by fog that came straight from the lights ...
    double scattered_more = 0;         // ... and that had been scattered before, by fog or surfaces
    int64_t hits = 0;                  // paths with recorded segments
    std::vector<float> of_stratum{};   // per stratum: Σ over paths of (power · recorded length)²; empty = not needed
};

// Traces `count` of `total` paths: `first`, `first + step` and so on. All paths are stratified together, and each has
// its own random numbers. Results are weighted such that those of all `total` paths sum to an estimate of the whole.
void trace_light_paths(const Snapshot& snapshot, const RayStrata& strata, const LightPathRules& rules, int64_t first,
                       int64_t count, int64_t total, LightPathResult& result, int64_t step = 1);

// Where light paths go: fog and surfaces; in unbounded fog also the surroundings that light scatters back from.
Box light_reach(const Snapshot& snapshot);

// Bounds of the fog within a box.
Box fog_bounds(const Snapshot& snapshot, const Box& reach);
}

// Ray-marching steps from local majorants, with none in empty space.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct Medium;

struct Step {
    float low, high; // meters along the ray
};

struct StepRule {
    float optical_depth = 0.25f;       // maximum optical depth (by the local majorant) per step
    float voxels = 2;                  // maximum voxels crossed per step, in nonconstant bricks
    float length = 1;                  // longest step anywhere, meters
    int most = 4096;                   // maximum steps per ray; steps are lengthened to fit
    std::span<const vec3> near_points; // positions of local lights ...
    float near_ratio = 0.25f;      // ... a step is at most this fraction of the distance to each (but see near_least)
    std::span<const Step> beams{}; // intervals of the ray that need finer steps ...
    float beam_steps = 8;          // ... at least this many, of equal length
    float near_least = 1e-3f;      // meters; distances are clamped to at least this
};

// Appends the steps of the ray on 0..t_max, ascending and disjoint; together they cover all fog. Each step has an equal
// share of the accumulated step rate, so there are no slivers, and halving every limit halves every step. The voxel in
// which density rises from 0 at a face of a grid's box gets a separate step if it is shorter than the others. Omits
// invisible fog: behind optical depth 64 of homogeneous or height fog, height fog thinner than 2^-24, anything beyond
// 1e12 m.
void append_steps(const Ray& ray, std::span<const Medium> media, const StepRule& rule, std::vector<Step>& steps);
}

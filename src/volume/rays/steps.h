// Where along a ray to evaluate the fog: steps from local majorants, none in empty space.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct Medium;

struct Step {
    float low, high; // metres along the ray
};

struct StepRule {
    float optical_depth = 0.25f;       // most optical depth (by the local majorant) in one step
    float voxels = 2;                  // most voxels crossed in one step, in bricks that are not constant
    float length = 1;                  // longest step anywhere, metres
    int most = 4096;                   // steps a ray may take; longer steps beyond
    std::span<const vec3> near_points; // positions of local lights ...
    float near_ratio = 0.25f;          // ... a step is at most this share of the distance to each (but see near_least)
    std::span<const Step> beams{};     // stretches of the ray that need steps of their own ...
    float beam_steps = 8;              // ... at least so many, of equal length
    float near_least = 1e-3f;          // metres: distances below count as this
};

// Appends the steps of the ray 0..t_max, ascending and disjoint; together they cover all fog. Steps are equal shares of
// the local bounds added up, so none is a sliver, and halving every bound halves every step. The voxel in which density
// rises from 0 at a face of a grid's box has a step of its own, where others are longer. Left out is what nobody can
// see: behind optical depth 64 of fog in closed form, height fog thinner than 2^-24, anything beyond 1e12 m.
void append_steps(const Ray& ray, std::span<const Medium> media, const StepRule& rule, std::vector<Step>& steps);
}

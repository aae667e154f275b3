// Ray-marching steps according to the march settings.
#pragma once
#include "volume/rays/steps.h"

namespace tyndall {
// How surface shadows in the fog are computed: by shadow rays or shadow maps at each step, by integration over the lit
// intervals of the ray, or `exact`: likewise, with all other terms exact too (the reference).
enum class Visibility { off, rays, maps, intervals, exact };

struct MarchSettings {
    float step_depth = 0.25f;        // maximum optical depth per step
    float step_voxels = 8;           // maximum voxels per step
    float step_share = 1.0f / 28;    // longest step as a share of the ray's length in fog
    float near_light = 0.5f;         // a step is at most this fraction of the distance to a local light
    float min_transmittance = 1e-3f; // the march stops below this transmittance
    Visibility visibility = Visibility::intervals;
    int nodes = 4;         // Gauss–Legendre nodes per lit interval of homogeneous or height fog
    int light_marches = 0; // exact: nodes per ray from which transmittance to a light is marched; 0 = all
};

struct Light;
struct Snapshot;

struct MarchSteps {
    MarchSettings settings;
    std::vector<Light> lights;     // whose intensity or shadows the steps must resolve
    std::vector<vec3> near_points; // of the local lights among them
};
MarchSteps march_steps(const MarchSettings& settings, std::vector<Light> lights);

// The part of a ray's fog that gets most steps: the part inside the scene's bounds if the fog extends far beyond them,
// where there are no shadows; else all of it.
Interval<float> scene_part(const Snapshot& snapshot, const Ray& ray, Interval<float> fog);

// Appends the steps of a ray, ascending and disjoint.
void append_march_steps(const MarchSteps& rule, const Snapshot& snapshot, const Ray& ray, std::vector<Step>& steps);
}

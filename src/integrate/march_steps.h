// Where the march evaluates the fog of a ray: steps as its settings ask for.
#pragma once
#include "volume/rays/steps.h"

namespace tyndall {
// How shadows of surfaces in the fog are found: sampled by rays or looked up in maps at each step, integrated over the
// lit intervals of the ray, or so with everything else as exact: the reference.
enum class Visibility { off, rays, maps, intervals, exact };

struct MarchSettings {
    float step_depth = 0.25f;        // most optical depth per step
    float step_voxels = 8;           // most voxels per step
    float step_share = 1.0f / 28;    // longest step as a share of the ray's stretch through fog
    float near_light = 0.5f;         // a step is at most this share of the distance to a local light
    float min_transmittance = 1e-3f; // the march stops where less than this passes
    Visibility visibility = Visibility::intervals;
    int nodes = 4;         // Gauss–Legendre nodes on each lit stretch of fog in closed form
    int light_marches = 0; // exact: nodes of a ray from which the way to a light is marched; 0 = all
};

struct Light;
struct Snapshot;

struct MarchSteps {
    MarchSettings settings;
    std::vector<Light> lights;     // whose strength or shadows the steps have to resolve
    std::vector<vec3> near_points; // of the local ones among them
};
MarchSteps march_steps(const MarchSettings& settings, std::vector<Light> lights);

// The part of a ray's fog that gets most steps. Fog that goes on far beyond the scene holds no shadows there: what the
// scene covers gets steps of its own; else all of it.
Interval<float> scene_part(const Snapshot& snapshot, const Ray& ray, Interval<float> fog);

// Appends the steps of a ray, ascending and disjoint.
void append_march_steps(const MarchSteps& rule, const Snapshot& snapshot, const Ray& ray, std::vector<Step>& steps);
}

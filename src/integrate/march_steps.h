// Where the march evaluates the fog of a ray: steps as its settings ask for.
#pragma once
#include "integrate/march_settings.h"
#include "volume/rays/steps.h"

namespace tyndall {
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

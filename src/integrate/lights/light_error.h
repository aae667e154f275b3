// Error of an approximation of the light in fog, measured on a few camera rays.
#pragma once
#include "base/math.h"

#include <functional>

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

// Light that fog scatters along a ray: as it is, and as approximated.
struct RayLight {
    dvec3 exact{0}, approximate{0};
};

// Relative RMS error (rmse_rel) over 8×6 camera rays through the part of the image with fog, each up to its first
// surface, or those of a finer grid where few of them meet fog; 0 if none does, infinite if only the approximation has
// light. `light(ray, i)`: of the i-th ray.
double fog_light_error(const View& view, const Snapshot& snapshot,
                       const std::function<RayLight(const Ray& ray, uint32_t i)>& light);

// The same for an environment whose light is replaced by its unshadowed mean.
double mean_environment_error(const View& view, const Snapshot& snapshot);

// The same for a light whose surfaces cast no shadows.
double shadow_error(const View& view, const Snapshot& snapshot, const Light& light);
}

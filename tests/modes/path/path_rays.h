// The light of paths along many rays, each with random numbers of its own, and along one ray many times.
#pragma once
#include "integrate/ray_estimate.h"
#include "modes/settings.h"

#include <vector>

namespace tyndall {
struct Snapshot;
}

namespace tyndall::test {
// Lines evenly spread over all lines through a ball, up to where they leave its neighborhood: the mean of their light
// is in proportion to what the ball sends out.
std::vector<Ray> lines_through(vec3 center, float radius, int count);

std::vector<Scatter> path_light(const Snapshot& snapshot, const std::vector<Ray>& rays, int orders);

// Mean and standard error of independent values.
struct Mean {
    double value = 0, error = 0;
};
Mean mean_of(const std::vector<double>& values);

// a - factor b, ray by ray.
std::vector<double> difference(const std::vector<Scatter>& a, const std::vector<Scatter>& b, double factor = 1);

vec3 all_light(const Scatter& s);
vec3 fog_light(const Scatter& s);
vec3 surface_light(const Scatter& s);

ScatterFunction path_mode(const Snapshot& snapshot, int orders = all_orders);

RayEstimate traced(const Snapshot& snapshot, const Ray& ray, int samples, int orders = all_orders);
}

// Monte Carlo estimate of the light along one ray, with its standard error.
#pragma once
#include "integrate/ray_batch.h"

#include <functional>

namespace tyndall {
struct RayEstimate {
    dvec3 value{0}, error{0}; // mean and its standard error
};

// `part` extracts the estimated quantity from a sample. Uses 64 batches of `samples`, each with its own sequence.
RayEstimate estimate_ray(const ScatterFunction& scatter, const Ray& ray, int samples,
                         const std::function<vec3(const Scatter&)>& part);
}

// The mean light along one ray by a technique that samples, and how well it is known.
#pragma once
#include "integrate/ray_batch.h"

#include <functional>

namespace tyndall {
struct RayEstimate {
    dvec3 value{0}, error{0}; // mean and its standard error
};

// `part` picks what counts of a sample. 64 batches of `samples` each, every batch a sequence of its own.
RayEstimate estimate_ray(const ScatterFunction& scatter, const Ray& ray, int samples,
                         const std::function<vec3(const Scatter&)>& part);
}

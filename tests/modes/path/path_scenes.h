// Means of many paths, and scenes with surfaces made in memory.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/settings.h"
#include "support/meshes.h"

#include <functional>

namespace tyndall {
struct Snapshot;
}

namespace tyndall::test {
// Mean and standard error of what paths along one ray bring, from independent batches.
struct Estimate {
    dvec3 value{0}, error{0};
};

// `part` picks what counts of a sample. 64 batches of `samples` each, every batch a sequence of its own.
Estimate estimate(const ScatterFunction& scatter, const Ray& ray, int samples,
                  const std::function<vec3(const Scatter&)>& part);

vec3 all_light(const Scatter& s);
vec3 fog_light(const Scatter& s);
vec3 surface_light(const Scatter& s);

ScatterFunction path_mode(const Snapshot& snapshot, int orders = all_orders);

Estimate traced(const Snapshot& snapshot, const Ray& ray, int samples, int orders = all_orders);

}

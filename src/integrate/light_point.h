// Which point of a soft light casts the shadows of a whole camera ray.
#pragma once
#include "integrate/ray_batch.h"
#include "trace/light_ray.h"

namespace tyndall {
// Point k of `count` points of a light, for a ray of a batch: well spread over the samples of a pixel. The centre of a
// light that is a point.
LightPoint light_point(const RayBatch& batch, size_t ray, const Light& light, size_t light_index, uint32_t k,
                       uint32_t count);
}

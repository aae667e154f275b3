// A stage with a bit of everything, rays through it, and how their answers compare.
#pragma once
#include "integrate/ray_batch.h"
#include "support/tiny_scenes.h"

namespace tyndall::test {
float wavy(vec3 p);

// A grid and even fog over each other, a lamp and the sun, and things in their way.
Stage busy_stage();

std::vector<Ray> busy_rays(int count);

double mean_of(const std::vector<Scatter>& results);

double rms_difference(const std::vector<Scatter>& a, const std::vector<Scatter>& b);
}

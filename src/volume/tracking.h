// Light on its way through fog by null collisions: the fog is filled up to its local majorants with matter that does
// nothing, so that free paths become exponential and no integral is needed. Unbiased for any density.
#pragma once
#include "base/math.h"
#include "base/random.h"

namespace tyndall {
struct Medium;

// Distance along the ray, within `range`, of the first particle met; infinite when none is (delta tracking: Woodcock
// 1965). `first` in [0,1) decides the first free path. Counts density look-ups in `lookups`.
float collision_distance(const Medium& medium, const Ray& ray, Interval<float> range, float first, RandomStream& random,
                         int& lookups);

// An estimate, right on average, of the share of light that passes the stretch `range` of the ray; not above 1. Exact
// in homogeneous and height fog. In grids the least density of each brick dims by its closed form and the rest by ratio
// tracking (residual ratio tracking: Novák et al. 2014), four times as often as collisions would be while all light is
// left, less often with less of it. Ends small values by Russian roulette.
float ratio_transmittance(const Medium& medium, const Ray& ray, Interval<float> range, RandomStream& random,
                          int& lookups);
}

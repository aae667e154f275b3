// Null-collision tracking: fictitious matter fills the fog up to its local majorants, so that free paths are
// exponential and no integral is needed. Unbiased for any density.
#pragma once
#include "base/math.h"
#include "base/random.h"

namespace tyndall {
struct Medium;

// Samples the distance to the first real collision within `range`; infinite if there is none (delta tracking: Woodcock
// 1965). `first` in [0,1) samples the first free path. Adds the number of density lookups to `lookups`.
float collision_distance(const Medium& medium, const Ray& ray, Interval<float> range, float first, RandomStream& random,
                         int& lookups);

// The same with the extinction of one channel, 0 to 2. Multiplies `pdfs` by the probability of the same steps in each
// channel, up to a common factor (null-collision path integral: Miller et al. 2019).
float collision_distance(const Medium& medium, int channel, const Ray& ray, Interval<float> range, float first,
                         RandomStream& random, int& lookups, vec3& pdfs);

// Unbiased estimate of the transmittance on `range`, at most 1. Exact in homogeneous and height fog. In grids, residual
// ratio tracking (Novák et al. 2014): the minimum density of each brick is integrated analytically and the rest tracked
// at one to four times the residual majorant, by the remaining transmittance. Small values end by Russian roulette.
float ratio_transmittance(const Medium& medium, const Ray& ray, Interval<float> range, RandomStream& random,
                          int& lookups);

// The same for each channel, not limited to 1, with the effort spent on those with a high weight; 0 for weights of 0.
vec3 channel_transmittance(const Medium& medium, vec3 weights, const Ray& ray, Interval<float> range,
                           RandomStream& random, int& lookups);
}

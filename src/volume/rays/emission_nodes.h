// Where the light of a field is asked for along a ray: Gauss points in every voxel cell, more in cells across which the
// light changes by much. Free of the steps of whoever asks.
#pragma once
#include "base/math.h"

#include <functional>

namespace tyndall {
struct BrickPool;

// A place on the ray and the length that it stands for, metres.
struct EmissionNode {
    float t = 0, length = 0;
};

// Calls add(node) for the nodes of a ray on 0..t_max, ascending, where `luminance` (its maximum 1) is not 0. Light that
// falls by a factor of e^12 across a cell is off by less than 2 %, by e^2 .3 %; left out are bricks a millionth as
// bright as the brightest.
void find_emission_nodes(const BrickPool& luminance, const Ray& ray, const std::function<void(EmissionNode)>& add);
}

// Directions and points by chance, always the same ones.
#pragma once
#include "base/math.h"

#include <cstdint>

namespace tyndall::test {
vec3 random_direction(uint32_t index, uint32_t seed);
vec3 random_point(uint32_t index, uint32_t seed, const Box& box);
}

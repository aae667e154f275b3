// The order of leaves in an OpenVDB tree: by their 4096³, 128³ and 8³ cells, each in x, y, z order.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tyndall {
// Indices into `origins` (multiples of 8) in that order.
std::vector<uint32_t> in_tree_order(std::span<const ivec3> origins);
}

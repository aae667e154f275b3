// The order in which a tree holds its leaves: by their 4096³, 128³ and 8³ cells, each time x before y before z.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tyndall {
// Numbers of the leaves at `origins` (multiples of 8) in that order.
std::vector<uint32_t> in_tree_order(std::span<const ivec3> origins);
}

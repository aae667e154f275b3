#include "volume/vdb/tree_order.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
struct TreePlace {
    uint64_t root = 0;
    uint32_t inner = 0, number = 0;

    bool operator<(const TreePlace& other) const {
        return root != other.root ? root < other.root : inner < other.inner;
    }
};

TreePlace tree_place(ivec3 origin, uint32_t number) {
    assert((origin.x & 7) == 0 && (origin.y & 7) == 0 && (origin.z & 7) == 0);
    TreePlace place{.number = number};
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<uint64_t>((origin[axis] >> 12) + (1 << 19)); // 20 bits
        place.root |= cell << (40 - 20 * axis);
        place.inner |= static_cast<uint32_t>(origin[axis] >> 7 & 31) << (22 - 5 * axis);
        place.inner |= static_cast<uint32_t>(origin[axis] >> 3 & 15) << (8 - 4 * axis);
    }
    return place;
}
}

std::vector<uint32_t> in_tree_order(std::span<const ivec3> origins) {
    std::vector<TreePlace> places;
    places.reserve(origins.size());
    for (const ivec3 origin : origins) places.push_back(tree_place(origin, static_cast<uint32_t>(places.size())));
    std::sort(places.begin(), places.end());
    std::vector<uint32_t> result;
    result.reserve(places.size());
    for (const TreePlace& place : places) result.push_back(place.number);
    return result;
}
}

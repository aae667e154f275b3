// The hierarchy of boxes: halved at the median of the longest axis.
#include "trace/shadow_slices.h"

namespace tyndall {
namespace {
using Triangle = ShadowSlices::Triangle;

void append_node(ShadowSlices& slices, uint32_t first, uint32_t end) {
    constexpr uint32_t most = 4;
    Box box, middles;
    const auto middle = [](const Triangle& t) { return (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0f; };
    for (uint32_t i = first; i < end; ++i) {
        for (const vec3 corner : slices.triangles[i].corners) box.grow(corner);
        middles.grow(middle(slices.triangles[i]));
    }
    const size_t at = slices.nodes.size();
    slices.nodes.push_back({box.low, box.high, first, end - first});
    if (end - first <= most) return;

    const vec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = first + (end - first) / 2;
    const auto begin = slices.triangles.begin();
    std::nth_element(begin + first, begin + half, begin + end,
                     [&](const Triangle& a, const Triangle& b) { return middle(a)[axis] < middle(b)[axis]; });
    append_node(slices, first, half);
    slices.nodes[at].first = static_cast<uint32_t>(slices.nodes.size()), slices.nodes[at].count = 0;
    append_node(slices, half, end);
}
}

ShadowSlices make_shadow_slices(const std::vector<ShadowTriangle>& triangles) {
    ShadowSlices slices;
    for (const ShadowTriangle& t : triangles)
        if (!t.has_alpha) slices.triangles.push_back({{t.corners[0], t.corners[1], t.corners[2]}});
    if (!slices.triangles.empty()) append_node(slices, 0, static_cast<uint32_t>(slices.triangles.size()));
    return slices;
}
}

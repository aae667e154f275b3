// Builds the bounding volume hierarchy by median splits along the longest axis.
#include "trace/shadows/intervals/shadow_slices.h"

namespace tyndall {
namespace {
struct Triangle {
    vec3 corners[3];
};

void append_node(std::vector<Triangle>& triangles, uint32_t first, uint32_t end, ShadowSlices& slices) {
    Box box, middles;
    const auto middle = [](const Triangle& t) { return (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0f; };
    for (uint32_t i = first; i < end; ++i) {
        for (const vec3 corner : triangles[i].corners) box.grow(corner);
        middles.grow(middle(triangles[i]));
    }
    const size_t at = slices.nodes.size();
    slices.nodes.push_back({box.low, box.high, first, end - first});
    if (end - first <= ShadowSlices::most) return;

    const vec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t half = first + (end - first) / 2;
    const auto begin = triangles.begin();
    std::nth_element(begin + first, begin + half, begin + end,
                     [&](const Triangle& a, const Triangle& b) { return middle(a)[axis] < middle(b)[axis]; });
    append_node(triangles, first, half, slices), append_node(triangles, half, end, slices);
    slices.nodes[at].first = static_cast<uint32_t>(slices.nodes.size()), slices.nodes[at].count = 0;
}
}

ShadowSlices make_shadow_slices(const std::vector<ShadowTriangle>& triangles) {
    std::vector<Triangle> opaque;
    for (const ShadowTriangle& t : triangles)
        if (!t.has_alpha) opaque.push_back({{t.corners[0], t.corners[1], t.corners[2]}});
    ShadowSlices slices;
    if (opaque.empty()) return slices;
    append_node(opaque, 0, static_cast<uint32_t>(opaque.size()), slices);
    auto corners = std::make_shared<ShadowSlices::Corners>();
    for (size_t i = 0; i < 9; ++i) {
        std::vector<float>& values = corners->values[i];
        values.reserve(opaque.size() + ShadowSlices::most);
        for (const Triangle& t : opaque) values.push_back(t.corners[i / 3][static_cast<int>(i % 3)]);
        values.resize(opaque.size() + ShadowSlices::most);
    }
    slices.corners = std::move(corners);
    return slices;
}
}

// Exact shadows along a camera ray, without a sample: the plane through ray and light cuts the triangles into
// segments, each segment shadows one stretch of the ray, and what no segment shadows is lit (after Max 1986). A union
// of stretches needs no closed meshes: holes let light through, duplicated and coplanar faces change nothing.
#pragma once
#include "trace/light_ray.h"
#include "trace/occluders.h"
#include "volume/brick_walk.h"

#include <memory>
#include <vector>

namespace tyndall {
// Opaque triangles in a hierarchy of boxes, to be cut by planes.
struct ShadowSlices {
    struct Node {
        vec3 low, high;
        uint32_t first = 0; // of its triangles; of an inner node the second child (the first one follows it)
        uint32_t count = 0; // 0 = inner node
    };
    static constexpr uint32_t most = 8; // triangles of a leaf
    std::vector<Node> nodes;            // the root first; empty when nothing casts shadows
    std::vector<float> corners[9];      // of the triangles: [3 · corner + axis][triangle], and `most` more

    size_t triangles() const { return nodes.empty() ? 0 : corners[0].size() - most; }
    vec3 corner(uint32_t triangle, size_t i) const {
        return {corners[3 * i][triangle], corners[3 * i + 1][triangle], corners[3 * i + 2][triangle]};
    }
};
ShadowSlices make_shadow_slices(const std::vector<ShadowTriangle>& triangles); // those with alpha are left out

// Replaces `lit` by the stretches of the ray 0..t_max, ascending, from which the point of the light is seen. Like
// shadow rays, the slices look 0.9999 of the way to the point, and nothing inside the light's ball casts shadows.
void find_lit(const ShadowSlices& slices, const Ray& ray, const LightPoint& light, std::vector<Stretch>& lit);
}

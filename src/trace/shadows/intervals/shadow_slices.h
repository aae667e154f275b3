// Exact shadows along a camera ray, without sampling: the plane through ray and light cuts the triangles into segments,
// each segment shadows one interval of the ray, and the rest is lit (after Max 1986). A union of intervals needs no
// closed meshes: holes let light through, duplicate and coplanar faces change nothing.
#pragma once
#include "trace/lights/light_ray.h"
#include "trace/occlusion/occluders.h"
#include "volume/bricks/brick_walk.h"

#include <memory>
#include <span>
#include <vector>

namespace tyndall {
// Opaque triangles in a bounding volume hierarchy, to be cut by planes.
struct ShadowSlices {
    struct Node {
        vec3 low, high;
        uint32_t first = 0; // its first triangle; of an inner node, the node to skip to if its box is missed
        uint32_t count = 0; // 0 = inner node; its first child follows it
    };
    struct Corners {
        std::vector<float> values[9]; // [3 · corner + axis][triangle], padded by `most`
        vec3 of(uint32_t triangle, size_t i) const {
            return {values[3 * i][triangle], values[3 * i + 1][triangle], values[3 * i + 2][triangle]};
        }
    };
    static constexpr uint32_t most = 8; // maximum triangles of a leaf
    std::vector<Node> nodes;            // depth first; empty when nothing casts shadows
    std::shared_ptr<const Corners> corners;

    size_t triangles() const { return corners ? corners->values[0].size() - most : 0; }
};
ShadowSlices make_shadow_slices(const std::vector<ShadowTriangle>& triangles); // those with alpha are left out

// The triangles that may shadow any of the rays, each with its own point of the light. Speeds up find_lit() for
// coherent rays with one origin, without changing its results. At least one ray.
ShadowSlices coherent_slices(const ShadowSlices& slices, std::span<const Ray> rays, std::span<const LightPoint> points);

// Replaces `lit` by the intervals of the ray 0..t_max, ascending, from which the light's point is visible. Like shadow
// rays, slices end at shadow_reach of the distance to the point, and nothing inside the light's sphere casts shadows.
void find_lit(const ShadowSlices& slices, const Ray& ray, const LightPoint& light, std::vector<Interval<double>>& lit);

// The same for up to 16 rays, each with its own point of one light; fast for coherent rays after coherent_slices().
void find_lit(const ShadowSlices& slices, std::span<const Ray> rays, std::span<const LightPoint> points,
              std::vector<Interval<double>> (&lit)[16]);
}

// The region of fog that an image's rays can cross.
#pragma once
#include "trace/view.h"

#include <vector>

namespace tyndall {
struct Snapshot;

// normal · (point - anchor) >= -offset
struct HalfSpace {
    vec3 normal{0};
    float offset = 0;
};

struct ViewFrustum {
    vec3 anchor{0};
    std::vector<HalfSpace> sides; // the frustum is their intersection; none = all space
};

// The planes through the camera and the image's edges, widened for pixel filters and lenses; the plane of the camera;
// and the sides of the fog's bounding box.
ViewFrustum view_frustum(const View& view, const Snapshot& snapshot, vec3 anchor);

// How far rays reach beyond the image's edges, pixels.
inline float edge_margin(const View& view) { return view.filter_radius + 1; }

// The interval of a ray that lies within radius + growth · t of the frustum. `offset`: the ray's origin relative to the
// anchor.
Interval<float> seen_interval(const ViewFrustum& space, vec3 offset, vec3 direction, float radius, float growth);
}

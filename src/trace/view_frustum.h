// The space that the rays of a picture cross on their way through fog.
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
    std::vector<HalfSpace> sides; // what all of them hold is seen; none: everything
};

// Planes through the picture's edges and the camera, and the sides of a box around the fog. Pixel filters look a little
// past the edges.
ViewFrustum view_frustum(const View& view, const Snapshot& snapshot, vec3 anchor);

// How far past the picture's edges rays go, pixels.
inline float past_edge(const View& view) { return view.filter_radius + 1; }

// The stretch of a ray on which it comes near seen space: nearer than radius + growth · t. The ray's origin is given as
// its offset from the anchor.
Interval<float> seen_stretch(const ViewFrustum& space, vec3 offset, vec3 direction, float radius, float growth);
}

#include "trace/view_frustum.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
void append_side(const dvec3& normal, const dvec3& on, ViewFrustum& space) {
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length)) return;
    const double offset = glm::dot(normal / length, dvec3(space.anchor) - on);
    const double rounding = 1e-6 * std::abs(offset);
    if (std::isfinite(offset)) space.sides.push_back({vec3(normal / length), static_cast<float>(offset + rounding)});
}

// The plane through the rays of two adjacent corners, facing the middle of the image.
void append_edge(const Ray& a, const Ray& b, const Ray& middle, ViewFrustum& space) {
    const dvec3 from = a.origin, to = dvec3(b.origin) + dvec3(b.direction);
    const dvec3 normal = glm::cross(dvec3(a.direction), to - from);
    const double side = glm::dot(normal, dvec3(middle.origin) + dvec3(middle.direction) - from);
    append_side(side < 0 ? -normal : normal, from, space);
}
}

// Rays through a lens of radius r focused at f deviate by r |1 - z/f| at depth z, at most r + r z/f. They stay inside a
// pinhole frustum widened by r/f per meter of depth, with its sides moved outward by r.
ViewFrustum view_frustum(const View& view, const Snapshot& snapshot, vec3 anchor) {
    ViewFrustum space{anchor, {}};
    const Lens& lens = view.camera.lens;
    const float wider = lens ? 0.5f * blur_diameter(view.camera, view.size, infinity) : 0;
    const vec2 low(-edge_margin(view) - wider), high = vec2(view.size) - low;
    const vec2 corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
    const auto ray = [&](vec2 at) { return camera_ray(view.camera, view.size, at); };
    for (int i = 0; i < 4; ++i)
        append_edge(ray(corners[i]), ray(corners[(i + 1) % 4]), ray(0.5f * vec2(view.size)), space);
    for (HalfSpace& side : space.sides) side.offset += lens.radius;
    append_side(view.camera.forward, view.camera.position, space);

    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 normal(0);
        normal[axis] = 1;
        append_side(normal, fog.low, space), append_side(-normal, fog.high, space);
    }
    return space;
}

Interval<float> seen_interval(const ViewFrustum& space, vec3 offset, vec3 direction, float radius, float growth) {
    Interval<float> stretch{0, infinity};
    for (const HalfSpace& side : space.sides) {
        // at + slope · t >= 0
        const float at = glm::dot(side.normal, offset) + side.offset + radius;
        const float slope = glm::dot(side.normal, direction) + growth;
        if (slope > 0) stretch.low = std::max(stretch.low, -at / slope);
        if (slope < 0) stretch.high = std::min(stretch.high, at / -slope);
        if (slope == 0 && at < 0) return {};
    }
    return stretch;
}
}

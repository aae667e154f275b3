// Handles of lights in the image: which light is under the pointer, and where a drag moves it. Pixels count from the
// upper left, as in camera.h. Stateless: a drag is always computed from where it began.
#pragma once
#include "scene/camera.h"
#include "viewer/editing/scene_edit.h"

#include <optional>

namespace tyndall {
// Where a light is drawn. A sun without a position is drawn at `sun_position`.
struct LightIcon {
    size_t light = 0;
    vec3 place{0};
    vec2 pixel{0};
    float depth = 0; // planar
};
std::vector<LightIcon> light_icons(const Camera& camera, ivec2 size, const Scene& scene, double seconds,
                                   vec3 sun_position = vec3(0));

// The light whose icon is nearest to a pixel, at most `reach` pixels away; of two at the same pixel, the one nearer to
// the camera.
std::optional<size_t> pick_light(const Camera& camera, ivec2 size, vec2 pixel, const Scene& scene, double seconds,
                                 float reach = 12, vec3 sun_position = vec3(0));

// Meters per pixel, perpendicular to the view, at the depth of a point.
float pixel_size(const Camera& camera, ivec2 size, vec3 point);

// What can be dragged: the light itself moves parallel to the image plane, an axis moves it along that world axis, the
// tip of its direction rotates it.
enum class Handle { view, x, y, z, direction };

struct HandlePoint {
    Handle handle = Handle::view;
    vec2 pixel{0};
};

// The tips of a light's handles, `length` pixels from its icon before foreshortening. Leaves out those that the light
// does not have or that point at the camera.
std::vector<HandlePoint> light_handles(const Camera& camera, ivec2 size, const LightIcon& icon, const Scene& scene,
                                       double seconds, float length = 70);
std::optional<Handle> pick_handle(std::span<const HandlePoint> handles, vec2 pixel, float reach = 10);

// The translation of a point at `place`, parallel to the image plane, when the pointer goes from one pixel to another.
vec3 drag_across_view(const Camera& camera, ivec2 size, vec3 place, vec2 from, vec2 to);

// The translation along a unit axis that follows the pointer along the axis's projection; 0 if the axis points at the
// camera or the pointer is beyond its vanishing point.
vec3 drag_along_axis(const Camera& camera, ivec2 size, vec3 place, vec3 axis, vec2 from, vec2 to);

// The unit direction whose tip, `length` meters from `place`, is under the pointer: on the same side of the sphere as
// `direction`, towards the camera or away from it, and on its outline if the pointer is outside it.
vec3 drag_direction(const Camera& camera, ivec2 size, vec3 place, vec3 direction, float length, vec2 to);

// The edits by which a drag changes a light. `scene` is as it was when the drag began. Empty for handles the light does
// not have.
std::vector<Edit> drag_light(const Camera& camera, ivec2 size, const Scene& scene, const LightIcon& icon, Handle handle,
                             vec2 from, vec2 to, double seconds, float length = 70);
}

// Grips on lights in the picture: which light is under the pointer, and where it goes when it is dragged. Pixels count
// from the upper left, as in camera.h. Nothing here keeps state: a drag is always worked out from where it began.
#pragma once
#include "scene/camera.h"
#include "viewer/editing/scene_edit.h"

#include <optional>

namespace tyndall {
// Where a light is drawn. A sun without a place of its own is drawn at `sun_place`.
struct LightIcon {
    size_t light = 0;
    vec3 place{0};
    vec2 pixel{0};
    float depth = 0; // planar
};
std::vector<LightIcon> light_icons(const Camera& camera, ivec2 size, const Scene& scene, double seconds,
                                   vec3 sun_place = vec3(0));

// The light whose icon is nearest to a pixel, at most `reach` pixels away; of two at one pixel the nearer to the eye.
std::optional<size_t> pick_light(const Camera& camera, ivec2 size, vec2 pixel, const Scene& scene, double seconds,
                                 float reach = 12, vec3 sun_place = vec3(0));

// Metres that a pixel spans across the view at a point.
float pixel_span(const Camera& camera, ivec2 size, vec3 point);

// What can be taken hold of: the light itself moves across the view, an axis along the world's, the tip of its
// direction turns it.
enum class Handle { view, x, y, z, direction };

struct HandlePoint {
    Handle handle = Handle::view;
    vec2 pixel{0};
};

// The ends of a light's handles, `length` pixels from its icon where nothing is foreshortened. Those that the light
// does not have, or that point at the eye, are left out.
std::vector<HandlePoint> light_handles(const Camera& camera, ivec2 size, const LightIcon& icon, const Scene& scene,
                                       double seconds, float length = 70);
std::optional<Handle> pick_handle(std::span<const HandlePoint> handles, vec2 pixel, float reach = 10);

// How far a thing at `place` moves when the pointer goes from one pixel to another.
vec3 drag_across_view(const Camera& camera, ivec2 size, vec3 place, vec2 from, vec2 to);

// As far along the axis (unit) as the pointer goes along the line that the axis draws; nothing where the axis points at
// the eye or the pointer is beyond its vanishing point.
vec3 drag_along_axis(const Camera& camera, ivec2 size, vec3 place, vec3 axis, vec2 from, vec2 to);

// The direction (unit) whose tip, `length` metres from `place`, is under the pointer: on the side of the sphere,
// towards the eye or away, that `direction` is on, and on its outline when the pointer is beside it.
vec3 drag_direction(const Camera& camera, ivec2 size, vec3 place, vec3 direction, float length, vec2 to);

// The edits that bring a light to where a drag takes it. `scene` is as it was when the drag began. Nothing for handles
// the light does not have.
std::vector<Edit> drag_light(const Camera& camera, ivec2 size, const Scene& scene, const LightIcon& icon, Handle handle,
                             vec2 from, vec2 to, double seconds, float length = 70);
}

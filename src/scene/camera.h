// A camera at one time: a pinhole or a thin lens.
#pragma once
#include "base/math.h"
#include "scene/lens.h"

#include <optional>
#include <string>

namespace tyndall {
struct Camera {
    std::string name;
    vec3 position{0, 1, 4};
    vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1}; // orthonormal
    float vertical_fov = 0.8f;                           // radians; perspective
    float ortho_height = 0;                              // meters; above 0 the camera is orthographic
    float near = 0.01f, far = infinity;
    Lens lens; // of a perspective camera
};

// Fields in the order of cache files.
template<class Visit> void fields(Camera& camera, Visit& visit) {
    visit(camera.name), visit(camera.position), visit(camera.right), visit(camera.up), visit(camera.forward);
    visit(camera.vertical_fov), visit(camera.ortho_height), visit(camera.near), visit(camera.far);
    fields(camera.lens, visit);
}

// Camera at `position` looking at `target`; `up` need not be perpendicular.
Camera look_at(vec3 position, vec3 target, vec3 up, float vertical_fov);

// The ray through the center of the lens and a point of the image in pixels; (0,0) is the upper left corner of the
// upper left pixel.
Ray camera_ray(const Camera& camera, ivec2 size, vec2 pixel);

// Pinhole projection of a point into the image, in pixels from the upper left; may lie outside. Empty for points behind
// the camera.
std::optional<vec2> pixel_of(const Camera& camera, ivec2 size, vec3 point);
// The same for a point at an offset from the camera.
std::optional<vec2> pixel_of_offset(const Camera& camera, ivec2 size, vec3 offset);

// Height of the view at a distance along the viewing direction, meters.
inline float view_height(const Camera& camera, float depth = 1) {
    return camera.ortho_height > 0 ? camera.ortho_height : 2 * depth * std::tan(0.5f * camera.vertical_fov);
}

// The planar depths that a box spans.
Interval<float> planar_depths(const Camera& camera, const Box& box);

// Distance along the viewing direction (planar z) of a point on a ray of this camera.
inline float planar_depth(const Camera& camera, const Ray& ray, float t) {
    return glm::dot(ray.at(t) - camera.position, camera.forward);
}
}

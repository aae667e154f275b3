// A camera at one moment: a pinhole, or a thin lens around it.
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
    float ortho_height = 0;                              // metres; above 0 the camera is orthographic
    float near = 0.01f, far = infinity;
    Lens lens; // of a perspective camera
};

// Of cache files, in this order.
template<class Visit> void fields(Camera& camera, Visit& visit) {
    visit(camera.name), visit(camera.position), visit(camera.right), visit(camera.up), visit(camera.forward);
    visit(camera.vertical_fov), visit(camera.ortho_height), visit(camera.near), visit(camera.far);
    fields(camera.lens, visit);
}

// Camera at `position` looking at `target`; `up` need not be perpendicular.
Camera look_at(vec3 position, vec3 target, vec3 up, float vertical_fov);

// The ray through a point of the picture in pixels and the middle of the lens, (0,0) the upper left corner of the upper
// left pixel.
Ray camera_ray(const Camera& camera, ivec2 size, vec2 pixel);

// Where a point, in focus, appears in the picture, in pixels from the upper left; may lie outside. Nothing behind the
// camera.
std::optional<vec2> pixel_of(const Camera& camera, ivec2 size, vec3 point);

// Distance along the viewing direction (planar z) of a point on a ray of this camera.
inline float planar_depth(const Camera& camera, const Ray& ray, float t) {
    return glm::dot(ray.at(t) - camera.position, camera.forward);
}
}

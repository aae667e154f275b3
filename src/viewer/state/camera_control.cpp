#include "viewer/state/camera_control.h"

#include "scene/scene.h"
#include "trace/moment.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
namespace {
constexpr float steepest = 0.4972f * pi; // largest elevation
constexpr float nearest = 1e-3f;         // smallest distance to the target, meters

// Rotates the camera's axes about the world's up and then about its own right, with limited elevation.
Camera rotated(Camera camera, vec2 angle) {
    const float elevation = std::asin(std::clamp(camera.forward.y, -1.0f, 1.0f));
    const float low = std::min(elevation, -steepest), high = std::max(elevation, steepest);
    const float tilt = std::clamp(elevation + angle.y, low, high) - elevation;
    const mat3 turn(glm::rotate(mat4(1), -angle.x, vec3(0, 1, 0)));
    const vec3 right = glm::normalize(turn * camera.right);
    const mat3 whole = mat3(glm::rotate(mat4(1), tilt, right)) * turn;
    camera.forward = glm::normalize(whole * camera.forward);
    camera.right = glm::normalize(right - glm::dot(right, camera.forward) * camera.forward);
    camera.up = glm::cross(camera.right, camera.forward);
    return camera;
}
}

Viewpoint viewpoint_of(const Scene& scene, int camera, double seconds) {
    Viewpoint view{camera_at(scene, camera, seconds), 5};
    const CameraSource& source = scene.cameras[static_cast<size_t>(camera)];
    if (source.node < 0) {
        view.distance = glm::distance(source.position.at(seconds), source.target.at(seconds));
    } else if (const Box box = scene_bounds(scene, seconds);
               !box.empty() && is_finite(box.low) && is_finite(box.high)) {
        const float ahead = glm::dot(box.center() - view.camera.position, view.camera.forward);
        view.distance = std::max(ahead, 0.1f * glm::length(box.size()));
    }
    view.distance = std::max(view.distance, nearest);
    return view;
}

Viewpoint orbited(Viewpoint from, vec2 angle) {
    const vec3 target = from.target();
    from.camera = rotated(from.camera, angle);
    from.camera.position = target - from.distance * from.camera.forward;
    return from;
}

Viewpoint turned(Viewpoint from, vec2 angle) {
    from.camera = rotated(from.camera, angle);
    return from;
}

Viewpoint panned(Viewpoint from, vec2 heights) {
    const vec2 meters = heights * view_height(from.camera, from.distance); // at the target
    from.camera.position -= meters.x * from.camera.right + meters.y * from.camera.up;
    return from;
}

Viewpoint dollied(Viewpoint from, float factor) {
    const vec3 target = from.target();
    from.distance = std::max(from.distance * factor, nearest);
    from.camera.position = target - from.distance * from.camera.forward;
    from.camera.ortho_height *= factor;
    return from;
}

Viewpoint flown(Viewpoint from, vec3 meters) {
    from.camera.position += meters.x * from.camera.right + vec3(0, meters.y, 0) + meters.z * from.camera.forward;
    return from;
}
}

// Camera frames, camera rays and projection.
#include "scene/camera.h"

namespace tyndall {
Camera look_at(vec3 position, vec3 target, vec3 up, float vertical_fov) {
    Camera camera;
    camera.position = position;
    camera.vertical_fov = vertical_fov;
    const vec3 towards = target - position;
    if (glm::dot(towards, towards) > 0) camera.forward = glm::normalize(towards);

    // If `up` is parallel to the view, any perpendicular direction will do.
    vec3 right = glm::cross(camera.forward, up);
    if (!(glm::dot(right, right) > 1e-12f * glm::dot(up, up))) {
        vec3 across;
        make_frame(camera.forward, right, across);
    }
    camera.right = glm::normalize(right);
    camera.up = glm::cross(camera.right, camera.forward);
    return camera;
}

// tan(fov / 2), cached for consecutive rays of one camera.
static float half_slope(float vertical_fov) {
    static thread_local float known = 0, slope = 0;
    if (known != vertical_fov) known = vertical_fov, slope = std::tan(0.5f * vertical_fov);
    return slope;
}

Ray camera_ray(const Camera& camera, ivec2 size, vec2 pixel) {
    const vec2 extent(size);
    const float aspect = extent.x / extent.y;
    const vec2 screen((2 * pixel.x / extent.x - 1) * aspect, 1 - 2 * pixel.y / extent.y);
    if (camera.ortho_height > 0) {
        const vec2 offset = screen * (0.5f * camera.ortho_height);
        return {camera.position + offset.x * camera.right + offset.y * camera.up, camera.forward, camera.far};
    }
    const vec2 slope = screen * half_slope(camera.vertical_fov);
    const vec3 direction = camera.forward + slope.x * camera.right + slope.y * camera.up;
    const float length = glm::length(direction);
    return {camera.position, direction / length, camera.far * length};
}

Interval<float> planar_depths(const Camera& camera, const Box& box) {
    const float middle = glm::dot(box.center() - camera.position, camera.forward);
    const float reach = glm::dot(0.5f * box.size(), glm::abs(camera.forward));
    return {middle - reach, middle + reach};
}

std::optional<vec2> pixel_of(const Camera& camera, ivec2 size, vec3 point) {
    return pixel_of_offset(camera, size, point - camera.position);
}

std::optional<vec2> pixel_of_offset(const Camera& camera, ivec2 size, vec3 offset) {
    const vec2 extent(size);
    vec2 screen(glm::dot(offset, camera.right), glm::dot(offset, camera.up));
    if (camera.ortho_height > 0) {
        screen *= 2 / camera.ortho_height;
    } else {
        const float depth = glm::dot(offset, camera.forward);
        if (!(depth > 0)) return {};
        screen /= depth * std::tan(0.5f * camera.vertical_fov);
    }
    return 0.5f * extent * vec2(screen.x * extent.y / extent.x + 1, 1 - screen.y);
}
}

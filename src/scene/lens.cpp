#include "scene/lens.h"

#include "scene/camera.h"

namespace tyndall {
namespace {
// Concentric map from the unit square to the unit disc, which preserves area (Shirley and Chiu 1997).
vec2 disc_point(vec2 u) {
    const vec2 at = 2.0f * u - 1.0f;
    if (at == vec2(0)) return at;
    const bool wide = std::abs(at.x) > std::abs(at.y);
    const float radius = wide ? at.x : at.y;
    const float angle = wide ? pi / 4 * (at.y / at.x) : pi / 2 - pi / 4 * (at.x / at.y);
    return radius * vec2(std::cos(angle), std::sin(angle));
}

// Picks one of the triangles between the center and two adjacent corners, and a point in it.
vec2 polygon_point(int corners, float rotation, vec2 u) {
    const float place = u.x * static_cast<float>(corners), first = std::min(std::floor(place), float(corners - 1));
    const float step = 2 * pi / static_cast<float>(corners), angle = rotation + step * first;
    const float outwards = std::sqrt(place - first);
    const vec2 a(std::cos(angle), std::sin(angle)), b(std::cos(angle + step), std::sin(angle + step));
    return outwards * glm::mix(a, b, u.y);
}
}

vec2 aperture_point(const Lens& lens, vec2 u) {
    return lens.radius * (lens.blades >= 3 ? polygon_point(lens.blades, lens.rotation, u) : disc_point(u));
}

Ray lens_ray(const Camera& camera, ivec2 size, vec2 pixel, vec2 on_aperture) {
    const Ray middle = camera_ray(camera, size, pixel);
    const vec3 off = on_aperture.x * camera.right + on_aperture.y * camera.up;
    const vec3 per_depth = middle.direction / glm::dot(middle.direction, camera.forward) - off / camera.lens.focus;
    const float length = glm::length(per_depth);
    return {camera.position + off, per_depth / length, camera.far * length};
}

float blur_diameter(const Camera& camera, ivec2 size, float depth) {
    const float pixels = static_cast<float>(size.y) / view_height(camera); // at unit depth
    return 2 * camera.lens.radius * std::abs(1 / depth - 1 / camera.lens.focus) * pixels;
}

float lens_reach(const Lens& lens, float depth) { return lens ? lens.radius * std::abs(1 - depth / lens.focus) : 0; }
}

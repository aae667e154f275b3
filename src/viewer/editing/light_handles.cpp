#include "viewer/editing/light_handles.h"
#include "scene/scene.h"

namespace tyndall {
namespace {
constexpr float parallel = 1e-6f; // squared sine below which a ray does not determine a position along an axis

bool has(const Scene& scene, size_t light, std::string_view property) {
    for (const Property* each : properties_of(scene, Part::light, light))
        if (property == each->name) return true;
    return false;
}

// Whether a light is a sun without a position.
bool is_nowhere(const LightSource& light) {
    return is_distant(light) && light.node < 0 && light.position.times.empty() && light.position.values[0] == vec3(0);
}

vec3 axis_of(Handle handle) {
    return {handle == Handle::x ? 1.0f : 0.0f, handle == Handle::y ? 1.0f : 0.0f, handle == Handle::z ? 1.0f : 0.0f};
}

bool is_axis(Handle handle) { return handle == Handle::x || handle == Handle::y || handle == Handle::z; }

// The intersection of a pixel's ray with the plane through a point perpendicular to the view.
vec3 across_view(const Camera& camera, ivec2 size, vec3 place, vec2 pixel) {
    const Ray ray = camera_ray(camera, size, pixel);
    return ray.at(glm::dot(place - ray.origin, camera.forward) / glm::dot(ray.direction, camera.forward));
}

// The point nearest to a pixel on the projection of an axis through a point into the image.
std::optional<vec2> on_drawn_axis(const Camera& camera, ivec2 size, vec3 place, vec3 axis, vec2 pixel) {
    const vec3 step = 16 * pixel_size(camera, size, place) * axis;
    const std::optional<vec2> a = pixel_of(camera, size, place), b = pixel_of(camera, size, place + step);
    if (!a || !b || *a == *b) return {};
    const vec2 along = glm::normalize(*b - *a);
    return *a + glm::dot(pixel - *a, along) * along;
}

// Distance along an axis through a point to where it is nearest to a ray. For the lines p + s·a and o + t·d with unit
// directions, the shortest segment between them is perpendicular to both.
std::optional<float> along_axis(const Ray& ray, vec3 place, vec3 axis) {
    const vec3 offset = place - ray.origin;
    const float cosine = glm::dot(axis, ray.direction), sine2 = 1 - cosine * cosine;
    if (!(sine2 > parallel)) return {};
    const float s = (cosine * glm::dot(offset, ray.direction) - glm::dot(offset, axis)) / sine2;
    const float t = glm::dot(offset + s * axis, ray.direction);
    return t > 0 ? std::optional(s) : std::nullopt;
}
}

std::vector<LightIcon> light_icons(const Camera& camera, ivec2 size, const Scene& scene, double seconds,
                                   vec3 sun_position) {
    std::vector<LightIcon> icons;
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        LightIcon icon{
            i, is_nowhere(scene.lights[i]) ? sun_position : light_placement(scene, i, seconds).position, {}, 0};
        icon.depth = glm::dot(icon.place - camera.position, camera.forward);
        const std::optional<vec2> pixel = pixel_of(camera, size, icon.place);
        if (!pixel || !(icon.depth > 0)) continue;
        icon.pixel = *pixel;
        icons.push_back(icon);
    }
    return icons;
}

std::optional<size_t> pick_light(const Camera& camera, ivec2 size, vec2 pixel, const Scene& scene, double seconds,
                                 float reach, vec3 sun_position) {
    std::optional<LightIcon> best;
    float nearest = reach;
    for (const LightIcon& icon : light_icons(camera, size, scene, seconds, sun_position)) {
        const float away = glm::distance(icon.pixel, pixel);
        if (!(away < nearest || (away == nearest && (!best || icon.depth < best->depth)))) continue;
        nearest = away, best = icon;
    }
    return best ? std::optional(best->light) : std::nullopt;
}

float pixel_size(const Camera& camera, ivec2 size, vec3 point) {
    const float depth = glm::dot(point - camera.position, camera.forward);
    return view_height(camera, depth) / static_cast<float>(size.y);
}

std::vector<HandlePoint> light_handles(const Camera& camera, ivec2 size, const LightIcon& icon, const Scene& scene,
                                       double seconds, float length) {
    const float meters = length * pixel_size(camera, size, icon.place);
    const bool moves = has(scene, icon.light, "position");
    std::vector<HandlePoint> handles;
    if (moves) handles.push_back({Handle::view, icon.pixel});
    const auto add = [&](Handle handle, vec3 direction) {
        const std::optional<vec2> end = pixel_of(camera, size, icon.place + meters * direction);
        if (end && glm::distance(*end, icon.pixel) > 0.1f * length) handles.push_back({handle, *end});
    };
    for (const Handle axis : {Handle::x, Handle::y, Handle::z})
        if (moves) add(axis, axis_of(axis));
    if (is_aimed(scene.lights[icon.light]))
        add(Handle::direction, light_placement(scene, icon.light, seconds).direction);
    return handles;
}

std::optional<Handle> pick_handle(std::span<const HandlePoint> handles, vec2 pixel, float reach) {
    std::optional<Handle> best;
    for (const HandlePoint& point : handles)
        if (const float away = glm::distance(point.pixel, pixel); away <= reach) reach = away, best = point.handle;
    return best;
}

vec3 drag_across_view(const Camera& camera, ivec2 size, vec3 place, vec2 from, vec2 to) {
    return across_view(camera, size, place, to) - across_view(camera, size, place, from);
}

vec3 drag_along_axis(const Camera& camera, ivec2 size, vec3 place, vec3 axis, vec2 from, vec2 to) {
    const auto along = [&](vec2 pixel) -> std::optional<float> {
        const std::optional<vec2> drawn = on_drawn_axis(camera, size, place, axis, pixel);
        return drawn ? along_axis(camera_ray(camera, size, *drawn), place, axis) : std::nullopt;
    };
    const std::optional<float> begin = along(from), end = along(to);
    return begin && end ? (*end - *begin) * axis : vec3(0);
}

vec3 drag_direction(const Camera& camera, ivec2 size, vec3 place, vec3 direction, float length, vec2 to) {
    const Ray ray = camera_ray(camera, size, to);
    const float middle = glm::dot(place - ray.origin, ray.direction);
    const vec3 nearest = ray.at(middle) - place; // of the ray to the center of the sphere
    const float away2 = glm::dot(nearest, nearest), half2 = length * length - away2;
    if (half2 <= 0) return glm::normalize(nearest);
    const float side = glm::dot(direction, ray.direction) > 0 ? 1.0f : -1.0f;
    return glm::normalize(nearest + side * std::sqrt(half2) * ray.direction);
}

std::vector<Edit> drag_light(const Camera& camera, ivec2 size, const Scene& scene, const LightIcon& icon, Handle handle,
                             vec2 from, vec2 to, double seconds, float length) {
    const auto edit = [&](const char* property, vec3 value) {
        return has(scene, icon.light, property) ? std::vector{Edit{Part::light, icon.light, property, value, seconds}}
                                                : std::vector<Edit>{};
    };
    const LightPlacement now = light_placement(scene, icon.light, seconds);
    if (handle == Handle::view)
        return edit("position", now.position + drag_across_view(camera, size, icon.place, from, to));
    if (is_axis(handle))
        return edit("position", now.position + drag_along_axis(camera, size, icon.place, axis_of(handle), from, to));

    // The light rotates in place: the tip keeps its offset from the pointer, and a target keeps its distance.
    const float meters = length * pixel_size(camera, size, icon.place);
    const vec2 tip = pixel_of(camera, size, icon.place + meters * now.direction).value_or(from);
    const vec3 direction = drag_direction(camera, size, icon.place, now.direction, meters, tip + (to - from));
    const LightSource& light = scene.lights[icon.light];
    if (!light.target) return edit("direction", direction);
    const float distance = glm::distance(light.target->at(seconds), now.position);
    return edit("target", now.position + distance * direction);
}
}

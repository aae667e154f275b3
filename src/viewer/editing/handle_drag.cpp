#include "viewer/editing/handle_drag.h"

#include "scene/scene.h"
#include "viewer/state/edit_actions.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr float sun_height = 0.14f; // below the upper edge, as a fraction of the image's height
constexpr float sun_depth = 5;      // meters
constexpr int ring_points = 48;
}

std::vector<LightIcon> icons_in_view(const ViewState& state, ivec2 size, float gap) {
    const Camera camera = camera_now(state);
    const vec2 middle{0.5f * static_cast<float>(size.x), sun_height * static_cast<float>(size.y)};
    const Ray ray = camera_ray(camera, size, middle);
    const vec3 place = ray.at(sun_depth / glm::dot(ray.direction, camera.forward));
    std::vector<LightIcon> icons = light_icons(camera, size, *state.scene, seconds_of(state), place);
    float shift = 0;
    for (LightIcon& icon : icons) {
        if (icon.place != place) continue;
        const vec2 from = icon.pixel;
        icon.pixel.x += shift, shift += gap;
        icon.place += drag_across_view(camera, size, place, from, icon.pixel);
    }
    return icons;
}

const LightIcon* nearest_icon(std::span<const LightIcon> icons, vec2 pixel, float reach) {
    const LightIcon* best = nullptr;
    for (const LightIcon& icon : icons) {
        const float away = glm::distance(icon.pixel, pixel);
        if (away < reach || (best && away == reach && icon.depth < best->depth)) reach = away, best = &icon;
    }
    return best;
}

HandleDrag begin_drag(const ViewState& state, ivec2 size, const LightIcon& icon, Handle handle, vec2 from, float length,
                      uint64_t number) {
    HandleDrag drag;
    drag.number = number;
    drag.before = std::make_shared<Scene>();
    drag.before->lights = state.scene->lights, drag.before->nodes = state.scene->nodes;
    drag.camera = camera_now(state), drag.size = size, drag.seconds = seconds_of(state);
    drag.icon = icon, drag.handle = handle, drag.from = from, drag.length = length;
    return drag;
}

std::vector<Action> drag_actions(const HandleDrag& drag, vec2 to) {
    std::vector<Action> actions;
    for (const Edit& edit : drag_light(drag.camera, drag.size, *drag.before, drag.icon, drag.handle, drag.from, to,
                                       drag.seconds, drag.length))
        actions.push_back(action_of(*drag.before, edit, drag.number));
    return actions;
}

std::vector<vec2> beam_ring(const Camera& camera, ivec2 size, const Scene& scene, size_t light, double seconds,
                            float meters) {
    const LightPlacement place = light_placement(scene, light, seconds);
    const float angle = std::min(scene.lights[light].outer_cone.at(seconds), 0.49f * pi);
    const vec3 middle = place.position + meters * place.direction;
    const vec3 aside = std::abs(place.direction.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    const vec3 u = glm::normalize(glm::cross(place.direction, aside)), v = glm::cross(place.direction, u);
    std::vector<vec2> ring;
    for (int i = 0; i < ring_points; ++i) {
        const float turn = 2 * pi * static_cast<float>(i) / ring_points;
        const vec3 point = middle + meters * std::tan(angle) * (std::cos(turn) * u + std::sin(turn) * v);
        const std::optional<vec2> pixel = pixel_of(camera, size, point);
        if (!pixel) return {};
        ring.push_back(*pixel);
    }
    return ring;
}
}

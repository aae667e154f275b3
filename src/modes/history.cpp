#include "modes/history.h"
#include "scene/light.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <span>

namespace tyndall {
namespace {
constexpr float cut_cosine = 0.94f;  // of the angle the camera turns between two frames: 20 degrees
constexpr float cut_distance = 0.1f; // of the scene's diagonal
constexpr float switched = 0.8f;     // of what a light had, or had of what it has
constexpr float moved_on = 5e-4f;    // of its distance from the camera, or radians: what trails show in ten frames

bool same(const Settings& a, const Settings& b) {
    return std::ranges::all_of(setting_rows(), [&](const SettingRow& row) { return row.get(a) == row.get(b); });
}

bool is_cut(const View& a, const View& b, const Snapshot& snapshot) {
    const Camera &from = a.camera, &to = b.camera;
    const bool lens = from.vertical_fov != to.vertical_fov || from.ortho_height != to.ortho_height;
    const float far = cut_distance * glm::length(snapshot.bounds.size());
    return lens || from.name != to.name || glm::dot(from.forward, to.forward) < cut_cosine ||
           glm::dot(from.up, to.up) < cut_cosine || glm::length(to.position - from.position) > far;
}

std::vector<vec3> lights_of(const Snapshot& snapshot) {
    std::vector<vec3> lights;
    for (const Light& light : snapshot.lights)
        lights.insert(lights.end(), {light.intensity * light.volume_scale, is_distant(light) ? vec3(0) : light.position,
                                     !is_aimed(light) ? vec3(0) : light.direction});
    return lights;
}

// Whether a light is another, or was switched.
bool switched_lights(std::span<const vec3> from, std::span<const vec3> to) {
    if (from.size() != to.size()) return true;
    for (size_t i = 0; i < from.size(); i += 3) {
        const vec3 least = glm::min(from[i], to[i]), most = glm::max(from[i], to[i]);
        if (!glm::all(glm::greaterThanEqual(least, switched * most))) return true;
    }
    return false;
}

// Of as many lights: whether one would leave a trail.
bool moved_lights(std::span<const vec3> from, std::span<const vec3> to, vec3 eye) {
    for (size_t i = 0; i < from.size(); i += 3) {
        if (glm::distance(from[i + 1], to[i + 1]) > moved_on * glm::distance(to[i + 1], eye)) return true;
        if (glm::distance(from[i + 2], to[i + 2]) > moved_on) return true;
    }
    return false;
}
}

int follow(History& history, const View& view, const Snapshot& snapshot, const Settings& settings) {
    std::vector<vec3> lights = lights_of(snapshot);
    bool goes_on = history.frames > 0 && history.scene == snapshot.scene && history.view.size == view.size &&
                   !is_cut(history.view, view, snapshot) && same(history.settings, settings) &&
                   !switched_lights(history.lights, lights);
    // Froxels clamp what they remember to what they see around: a light may wander through them.
    if (goes_on && !history.froxels) goes_on = !moved_lights(history.lights, lights, view.camera.position);
    if (!goes_on) history = {};
    history.view = view, history.settings = settings;
    history.scene = snapshot.scene, history.lights = std::move(lights);
    return history.frames++;
}
}

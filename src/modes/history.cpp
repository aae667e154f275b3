#include "modes/history.h"

#include <algorithm>
#include <span>

namespace tyndall {
namespace {
constexpr float cut_cosine = 0.94f;  // of the angle the camera turns between two frames: 20 degrees
constexpr float cut_distance = 0.1f; // of the scene's diagonal
constexpr float switched = 0.5f;     // of what a light had, or had of what it has

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

std::vector<vec3> shining(const Snapshot& snapshot) {
    std::vector<vec3> lights;
    for (const Light& light : snapshot.lights) lights.push_back(light.intensity * light.volume_scale);
    return lights;
}

bool is_switched(std::span<const vec3> from, std::span<const vec3> to) {
    return !std::ranges::equal(from, to, [](vec3 a, vec3 b) {
        return glm::all(glm::greaterThanEqual(glm::min(a, b), switched * glm::max(a, b)));
    });
}
}

int follow(History& history, const View& view, const Snapshot& snapshot, const Settings& settings) {
    std::vector<vec3> lights = shining(snapshot);
    const bool goes_on = history.frames > 0 && history.scene == snapshot.scene && history.view.size == view.size &&
                         !is_cut(history.view, view, snapshot) && same(history.settings, settings) &&
                         !is_switched(history.lights, lights);
    if (!goes_on) history = {};
    history.view = view, history.settings = settings;
    history.scene = snapshot.scene, history.lights = std::move(lights);
    return history.frames++;
}
}

#include "modes/history.h"

#include "integrate/terms.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr float cut_cosine = 0.94f;  // of the camera's rotation between two frames: 20 degrees
constexpr float cut_distance = 0.1f; // of the scene's diagonal
constexpr float switched = 0.8f;     // minimum ratio of a light's intensities in two frames
constexpr float moved_on = 5e-4f;    // fraction of a light's distance from the camera, or radians: larger moves leave
                                     // visible trails over ten frames

bool is_cut(const View& a, const View& b, const Snapshot& snapshot) {
    const Camera &from = a.camera, &to = b.camera;
    const bool lens = from.vertical_fov != to.vertical_fov || from.ortho_height != to.ortho_height;
    const float far = cut_distance * glm::length(snapshot.bounds.size());
    return lens || from.name != to.name || glm::dot(from.forward, to.forward) < cut_cosine ||
           glm::dot(from.up, to.up) < cut_cosine || glm::length(to.position - from.position) > far;
}

bool is_switched(vec3 from, vec3 to) {
    return !glm::all(glm::greaterThanEqual(glm::min(from, to), switched * glm::max(from, to)));
}

// Whether a light changed its kind or brightness.
bool is_switched(const Light& from, const Light& to) {
    return from.kind != to.kind || is_switched(from.intensity * from.volume_scale, to.intensity * to.volume_scale);
}

bool is_turned(const LightAxes& from, const LightAxes& to) {
    return glm::distance(from.right, to.right) > moved_on || glm::distance(from.up, to.up) > moved_on;
}

bool is_same(const Gobo* from, const Gobo* to) {
    return from == to || (from && to && !to->content.empty() && from->content == to->content);
}

// Whether the light's angular distribution (IES profile or gobo) has changed.
bool shines_otherwise(const LightFilter* from, const LightFilter* to) {
    if (from == to) return false;
    if (!from || !to || from->profile != to->profile || !is_same(from->gobo.get(), to->gobo.get())) return true;
    return (to->profile && is_turned(from->profile_axes, to->profile_axes)) ||
           (to->gobo &&
            (is_turned(from->gobo_axes, to->gobo_axes) || glm::distance(from->gobo_half, to->gobo_half) > moved_on));
}

bool is_reshaped(const AreaShape* from, const AreaShape* to) {
    if (from == to) return false;
    if (!from || !to || !is_same(from->texture.get(), to->texture.get())) return true;
    return is_turned({from->right, from->up}, {to->right, to->up}) ||
           glm::distance(from->half, to->half) > moved_on * glm::length(to->half);
}

// Whether a light moved or changed shape enough to leave a trail in the history.
bool leaves_trail(const Light& from, const Light& to, vec3 eye) {
    if (!is_distant(to) && glm::distance(from.position, to.position) > moved_on * glm::distance(to.position, eye))
        return true;
    if (is_aimed(to) && glm::distance(from.direction, to.direction) > moved_on) return true;
    const float cones = std::abs(from.inner_cone - to.inner_cone) + std::abs(from.outer_cone - to.outer_cone);
    return (to.kind == LightKind::spot && cones > moved_on) || shines_otherwise(from.filter.get(), to.filter.get()) ||
           is_reshaped(from.area.get(), to.area.get());
}
}

int update_history(History& history, const View& view, const Snapshot& snapshot, const Settings& settings) {
    const std::vector<Light>& lights = snapshot.lights;
    const vec3 ambient = mean_ambient(snapshot);
    bool goes_on = history.frames > 0 && history.scene == snapshot.scene && history.view.size == view.size &&
                   !is_cut(history.view, view, snapshot) && same_settings(history.settings, settings) &&
                   !is_switched(history.ambient, ambient) &&
                   std::ranges::equal(history.lights, lights,
                                      [](const Light& from, const Light& to) { return !is_switched(from, to); });
    // Froxel history is clamped to its neighborhood, so lights may move.
    if (goes_on && !history.froxels)
        goes_on = std::ranges::equal(history.lights, lights, [&](const Light& from, const Light& to) {
            return !leaves_trail(from, to, view.camera.position);
        });
    if (!goes_on) history = {};
    history.view = view, history.settings = settings;
    history.scene = snapshot.scene, history.lights = lights, history.ambient = ambient;
    return history.frames++;
}
}

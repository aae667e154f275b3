#include "modes/history_limitations.h"

#include "scene/light.h"
#include "scene/pose.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "trace/shutter_motion.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
bool has_moving_shadows(const Snapshot& snapshot, const Light& light) {
    if (!shadow_casters(light, snapshot)) return false;
    const std::vector<Instance>& instances = snapshot.scene->instances;
    for (size_t i = 0; i < instances.size(); ++i)
        if (is_moving(*snapshot.scene, instances[i]) && shadows_light(light, snapshot, static_cast<int>(i)))
            return true;
    return false;
}
}

bool is_moving(const Snapshot& snapshot, const Light& light) {
    const auto moves = [&](const LightSource& source) {
        return source.name == light.name &&
               (!source.position.constant() || !source.direction.constant() || is_moving(*snapshot.scene, source.node));
    };
    return snapshot.scene && std::ranges::any_of(snapshot.scene->lights, moves);
}

void add_moving_camera(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    const auto moves = [&](const CameraSource& source) {
        return source.name == view.camera.name &&
               (!source.position.constant() || is_moving(*snapshot.scene, source.node));
    };
    if (snapshot.scene && std::ranges::any_of(snapshot.scene->cameras, moves))
        limitations.push_back({Severity::degraded, &limitation::moving_camera, Subject::camera, view.camera.name});
}

void add_moving_shadows(const Snapshot& snapshot, Limitations& limitations,
                        const std::function<bool(const Light&)>& counts) {
    const auto trails = [&](const Light& light) { return counts(light) && has_moving_shadows(snapshot, light); };
    if (snapshot.scene && std::ranges::any_of(snapshot.lights, trails))
        limitations.push_back({Severity::degraded, &limitation::moving_shadows, Subject::surfaces});
}

void add_moving_fog(const Snapshot& snapshot, Limitations& limitations) {
    if (!snapshot.scene) return;
    for (const MediumSource& medium : snapshot.scene->media)
        if (changes(medium) || medium.sequence.files.size() > 1)
            limitations.push_back({Severity::degraded, &limitation::moving_fog, Subject::medium, medium.name});
}
}

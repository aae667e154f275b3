#include "trace/moment.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/camera.h"
#include "scene/scene.h"

#include <algorithm>

namespace tyndall {
Moment moment_of(const Scene& scene, int frame) { return {frame, frame / scene.frame_rate, {}}; }

namespace {
// Visits what brightness depends on, of everything that gives light.
template<class Visit> void visit_brightness(const Scene& scene, const Visit& visit) {
    const auto visit_all = [&](const auto&... keyed) { (visit(keyed), ...); };
    const auto of_background = [&](const Background& map) {
        visit_all(map.color, map.zenith, map.ground, map.intensity, map.exposure);
    };
    for (const LightSource& light : scene.lights)
        visit_all(light.color, light.intensity, light.exposure, light.temperature, light.volume_scale,
                  light.surface_scale, light.width, light.height, light.radius, light.inner_cone, light.outer_cone);
    if (const auto& sky = scene.environment; sky.has_value()) {
        of_background(sky->map);
        visit_all(sky->intensity, sky->exposure, sky->volume_scale, sky->surface_scale);
    }
    of_background(scene.background), visit(scene.ambient);
    for (const MediumSource& medium : scene.media) {
        visit(medium.emission);
        if (medium.blackbody) visit_all(medium.blackbody->scale, medium.blackbody->tint);
    }
}

// The exposure of each of `count` moments, in seconds, if any brightness changes.
std::vector<std::vector<ExposedTime>> exposures(const Scene& scene, int frame, const Shutter& shutter, int count) {
    bool changes = false;
    std::vector<double> breaks;
    const auto seconds = [&](double time) { return (frame + time) / scene.frame_rate; };
    visit_brightness(scene, [&](const auto& keyed) {
        changes = changes || !keyed.constant();
        add_key_times(keyed, seconds(shutter.open), seconds(shutter.close), breaks);
    });
    if (!changes) return std::vector<std::vector<ExposedTime>>(static_cast<size_t>(count));
    for (double& time : breaks) time = time * scene.frame_rate - frame;
    std::ranges::sort(breaks);
    auto result = exposed_times(shutter, count, breaks);
    for (std::vector<ExposedTime>& times : result)
        for (ExposedTime& exposed : times) exposed.time = seconds(exposed.time);
    return result;
}
}

FrameMoments frame_moments(const Scene& scene, int frame, const Shutter& shutter, int count) {
    FrameMoments result{{frame, (frame + shutter.middle()) / scene.frame_rate}, {}};
    if (!shutter) return result;
    result.middle.exposed = exposures(scene, frame, shutter, 1).front();
    if (count < 2) return result;
    std::vector<std::vector<ExposedTime>> exposed = exposures(scene, frame, shutter, count);
    for (const double time : shutter_times(shutter, count)) {
        std::vector<ExposedTime>& own = exposed[result.moments.size()];
        result.moments.push_back({frame, (frame + time) / scene.frame_rate, {}, std::move(own)});
    }
    return result;
}

NodeFrame node_frame(const Scene& scene, int node, double seconds, const std::string& what) {
    const mat4 matrix = node_matrix(scene, node, seconds);
    const vec3 back(matrix[2]);
    if (!is_finite(vec3(matrix[3])) || !is_finite(back) || !(glm::length(back) > 0))
        refuse(scene.file.string(), what + ": the transform of its node is singular or not finite");
    return {vec3(matrix[3]), vec3(matrix[1]), -glm::normalize(back)};
}

namespace {
void set_lens(const Scene& scene, const CameraSource& source, double seconds, Camera& camera) {
    camera.lens = {source.aperture.at(seconds), infinity, source.blades, source.blade_rotation.at(seconds)};
    if (!camera.lens) return;
    camera.lens.focus =
        source.focus ? source.focus->at(seconds) : glm::distance(camera.position, source.target.at(seconds));
    if (!(camera.lens.focus > 0))
        refuse(scene.file.string(), "camera " + source.name + ": focus_distance must be positive");
}
}

Camera camera_at(const Scene& scene, int camera, double seconds) {
    const CameraSource& source = scene.cameras[camera];
    const float fov = source.vertical_fov.at(seconds);
    Camera result;
    if (source.node >= 0) {
        const NodeFrame frame = node_frame(scene, source.node, seconds, "camera " + source.name);
        result = look_at(vec3(0), frame.forward, frame.up, fov);
        result.position = frame.position;
    } else {
        const vec3 position = source.position.at(seconds), target = source.target.at(seconds);
        if (position == target) refuse(scene.file.string(), "camera " + source.name + ": position and target coincide");
        result = look_at(position, target, source.up.at(seconds), fov);
    }
    result.name = source.name;
    if (is_orthographic(source)) result.ortho_height = std::max(source.ortho_height.at(seconds), 1e-6f);
    result.near = source.near, result.far = source.far;
    set_lens(scene, source, seconds, result);
    return result;
}

int find_camera(const Scene& scene, const std::string& name) {
    if (scene.cameras.empty()) refuse(scene.file.string(), "the scene has no camera");
    if (name.empty()) return scene.camera;
    std::vector<std::string> names;
    for (const CameraSource& camera : scene.cameras) names.push_back(camera.name);
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<int>(i);
    fail(ExitCode::usage, "camera", unknown_name("camera", name, names));
}
}

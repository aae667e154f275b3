#include "trace/moment.h"

#include "base/error.h"
#include "base/text.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace tyndall {
Moment moment_of(const Scene& scene, int frame) { return {frame, frame / scene.frame_rate, {}}; }

FrameMoments frame_moments(const Scene& scene, int frame, const Shutter& shutter, int count) {
    FrameMoments result{{frame, (frame + shutter.middle()) / scene.frame_rate}, {}};
    if (!shutter || count < 2) return result;
    for (const double time : shutter_times(shutter, count))
        result.moments.push_back({frame, (frame + time) / scene.frame_rate});
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
    result.ortho_height = source.ortho_height;
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

#include "scene/pose.h"

#include "scene/scene.h"

#include <algorithm>

namespace tyndall {
namespace {
// The joint matrices of a vertex, blended by its weights.
mat4 skin_matrix(const Mesh& mesh, const Pose& pose, size_t vertex) {
    mat4 sum(0);
    const size_t first = vertex * mesh.influences;
    for (size_t i = first; i < first + mesh.influences; ++i)
        if (mesh.joint_weights[i] > 0) sum += mesh.joint_weights[i] * pose.joints[mesh.joints[i]];
    return sum;
}
}

Pose pose_of(const Scene& scene, const Instance& instance, double seconds) {
    Pose pose;
    for (const Keyed<float>& weight : instance.target_weights) pose.targets.push_back(weight.at(seconds));
    if (instance.skin < 0) return pose;
    const Skin& skin = scene.skins[static_cast<size_t>(instance.skin)];
    for (size_t i = 0; i < skin.joints.size(); ++i) {
        dmat4 world = world_matrix(scene, skin.joints[i], seconds) * dmat4(skin.inverse_bind[i]);
        world[3] -= glm::dvec4(scene.origin, 0);
        pose.joints.push_back(mat4(world));
    }
    return pose;
}

vec3 posed_position(const Mesh& mesh, const Pose& pose, size_t vertex) {
    vec3 position = mesh.positions[vertex];
    for (size_t t = 0; t < pose.targets.size(); ++t)
        if (pose.targets[t] != 0 && !mesh.targets[t].positions.empty())
            position += pose.targets[t] * mesh.targets[t].positions[vertex];
    return pose.joints.empty() ? position : vec3(skin_matrix(mesh, pose, vertex) * vec4(position, 1));
}

vec3 posed_normal(const Mesh& mesh, const Pose& pose, size_t vertex) {
    vec3 normal = mesh.normals[vertex];
    for (size_t t = 0; t < pose.targets.size(); ++t)
        if (pose.targets[t] != 0 && !mesh.targets[t].normals.empty())
            normal += pose.targets[t] * mesh.targets[t].normals[vertex];
    if (pose.joints.empty()) return normal;
    return glm::transpose(glm::inverse(mat3(skin_matrix(mesh, pose, vertex)))) * normal;
}

Box posed_bounds(const Mesh& mesh, const Pose& pose) {
    Box box;
    for (size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) box.grow(posed_position(mesh, pose, vertex));
    return box;
}

mat4 instance_matrix(const Scene& scene, const Instance& instance, double seconds) {
    return instance.skin >= 0 ? mat4(1) : node_matrix(scene, instance.node, seconds);
}

bool is_moving(const Scene& scene, const Instance& instance) {
    const auto keyed = [](const Keyed<float>& weight) { return !weight.constant(); };
    if (std::ranges::any_of(instance.target_weights, keyed)) return true;
    if (instance.skin < 0) return is_moving(scene, instance.node);
    return std::ranges::any_of(scene.skins[static_cast<size_t>(instance.skin)].joints,
                               [&](int joint) { return is_moving(scene, joint); });
}
}

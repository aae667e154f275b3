// Transforms and bounds of a scene's parts.
#include "scene/scene.h"

#include "base/text.h"
#include "scene/pose.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace tyndall {
namespace {
mat4 own_matrix(const Node& node, double seconds) {
    if (node.matrix) return *node.matrix;
    return glm::translate(mat4(1), node.translation.at(seconds)) * glm::mat4_cast(node.rotation.at(seconds)) *
           glm::scale(mat4(1), node.scale.at(seconds));
}
}

std::string GridSource::text() const { return joined(grids, "\n") + map.text(); }

dmat4 world_matrix(const Scene& scene, int node, double seconds) {
    dmat4 world(1);
    for (; node >= 0; node = scene.nodes[static_cast<size_t>(node)].parent) {
        const Node& here = scene.nodes[static_cast<size_t>(node)];
        dmat4 own(own_matrix(here, seconds));
        own[3] += glm::dvec4(here.remainder, 0);
        world = own * world;
    }
    return world;
}

mat4 node_matrix(const Scene& scene, int node, double seconds) {
    if (scene.origin != dvec3(0)) {
        dmat4 world = world_matrix(scene, node, seconds);
        world[3] -= glm::dvec4(scene.origin, 0);
        return mat4(world);
    }
    mat4 world(1);
    for (; node >= 0; node = scene.nodes[static_cast<size_t>(node)].parent)
        world = own_matrix(scene.nodes[static_cast<size_t>(node)], seconds) * world;
    return world;
}

std::string name_of_instance(const Scene& scene, int instance) {
    const Instance& placed = scene.instances[static_cast<size_t>(instance)];
    if (placed.node >= 0 && !scene.nodes[static_cast<size_t>(placed.node)].name.empty())
        return scene.nodes[static_cast<size_t>(placed.node)].name;
    const std::string& name = scene.meshes[static_cast<size_t>(placed.mesh)].name;
    return name.empty() ? "mesh " + std::to_string(placed.mesh) : name;
}

bool is_hidden(const Scene& scene, const LightSource& light, double seconds) {
    if (light.node < 0) return false;
    const mat4 matrix = node_matrix(scene, light.node, seconds);
    return is_finite(vec3(matrix[3])) && glm::length(vec3(matrix[2])) == 0;
}

const char* scale_problem(vec3 scale) {
    if (scale.x == 0 || scale.y == 0 || scale.z == 0) return "must not be 0: the fog would have no volume";
    const float volume = std::abs(scale.x * scale.y * scale.z);
    if (!(volume >= std::numeric_limits<float>::min())) return "is too small: the fog would have no volume";
    return volume < infinity ? nullptr : "is too large";
}

mat4 medium_matrix(const MediumSource& medium, double seconds) {
    const mat4 turned = glm::translate(mat4(1), medium.translation.at(seconds)) *
                        glm::mat4_cast(glm::normalize(medium.rotation.at(seconds)));
    const mat4 placed = glm::scale(turned, medium.scale.at(seconds));
    const mat4 upright(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1); // (x, y, z) to (x, z, -y), by columns
    return medium.z_up ? placed * upright : placed;
}

bool emits_light(const MediumSource& medium) {
    const auto any = [](const Keyed<vec3>& color) {
        return std::ranges::any_of(color.values, [](vec3 value) { return value != vec3(0); });
    };
    const auto& blackbody = medium.blackbody;
    const bool scaled =
        blackbody && std::ranges::any_of(blackbody->scale.values, [](float value) { return value != 0; });
    return any(medium.emission) || (scaled && any(blackbody->tint));
}

bool is_moving(const Scene& scene, int node) {
    for (; node >= 0; node = scene.nodes[static_cast<size_t>(node)].parent) {
        const Node& n = scene.nodes[static_cast<size_t>(node)];
        if (n.matrix) continue;
        if (!n.translation.constant() || !n.rotation.constant() || !n.scale.constant()) return true;
    }
    return false;
}

namespace {
Box box_of(const Mesh& mesh) {
    Box box;
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) box.grow(mesh.positions[triangle[corner]]);
    return box;
}

Box finite(const Box& box) { return is_finite(box.low) && is_finite(box.high) ? box : Box{}; }
}

Box scene_bounds(const Scene& scene, double seconds) {
    std::vector<Box> boxes;
    for (const Mesh& mesh : scene.meshes) boxes.push_back(box_of(mesh));
    Box bounds;
    for (const Instance& instance : scene.instances) {
        const size_t mesh = static_cast<size_t>(instance.mesh);
        const Pose pose = pose_of(scene, instance, seconds);
        const Box box = pose.empty() ? boxes[mesh] : posed_bounds(scene.meshes[mesh], pose);
        bounds.grow(finite(transform(instance_matrix(scene, instance, seconds), box)));
    }
    for (const MediumSource& medium : scene.media) {
        const Box local = medium.kind == MediumKind::noise ? medium.recipe->bounds : medium.bounds;
        if (medium.kind == MediumKind::vdb || !is_finite(local.low) || !is_finite(local.high)) continue;
        bounds.grow(finite(transform(medium_matrix(medium, seconds), local)));
    }
    return bounds;
}
}

#include "support/meshes.h"

#include "scene/scene.h"

namespace tyndall::test {
void add_mesh(Scene& scene, Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({-1, static_cast<int>(scene.meshes.size()) - 1});
}

void add_mesh(Scene& scene, Mesh mesh, const Node& node) {
    scene.nodes.push_back(node);
    add_mesh(scene, std::move(mesh));
    scene.instances.back().node = static_cast<int>(scene.nodes.size()) - 1;
}

Material blend_material(float alpha) {
    Material material;
    material.alpha_mode = AlphaMode::blend;
    material.alpha = alpha;
    return material;
}
}

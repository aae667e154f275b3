#include "support/meshes.h"

#include "scene/scene.h"

namespace tyndall::test {
Mesh quad(vec3 corner, vec3 a, vec3 b, int material) {
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = material;
    return mesh;
}

Mesh box_mesh(vec3 low, vec3 high, int material) {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(
            {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
    for (const glm::uvec4 side : {glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6), glm::uvec4(0, 1, 5, 4),
                                  glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5)}) {
        mesh.triangles.push_back({side.x, side.y, side.z});
        mesh.triangles.push_back({side.x, side.z, side.w});
    }
    mesh.material = material;
    return mesh;
}

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

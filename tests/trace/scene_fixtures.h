// Small scenes made in memory.
#pragma once
#include "base/random.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/occluders.h"

namespace tyndall::test {
// A parallelogram: corner, and the two edges from it.
inline Mesh quad(vec3 corner, vec3 a, vec3 b, int material = -1) {
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = material;
    return mesh;
}

inline Mesh box_mesh(vec3 low, vec3 high, int material = -1) {
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

// Adds the mesh once, at a node of its own when it is to be placed.
inline void add_mesh(Scene& scene, Mesh mesh, std::optional<Node> node = {}) {
    scene.meshes.push_back(std::move(mesh));
    int index = -1;
    if (node) scene.nodes.push_back(*node), index = static_cast<int>(scene.nodes.size()) - 1;
    scene.instances.push_back({index, static_cast<int>(scene.meshes.size()) - 1});
}

inline Material blend_material(float alpha) {
    Material material;
    material.alpha_mode = AlphaMode::blend;
    material.alpha = alpha;
    return material;
}

// Sixteen shadow rays; `lane` < 0 sets all of them.
inline void set_ray(Occluders::ShadowRays& rays, int lane, vec3 origin, vec3 direction, float t_max = infinity) {
    for (int i = lane < 0 ? 0 : lane; i < (lane < 0 ? 16 : lane + 1); ++i) {
        rays.ox[i] = origin.x, rays.oy[i] = origin.y, rays.oz[i] = origin.z;
        rays.dx[i] = direction.x, rays.dy[i] = direction.y, rays.dz[i] = direction.z;
        rays.t_min[i] = 0, rays.t_max[i] = t_max, rays.active[i] = -1;
    }
}

inline vec3 random_direction(uint32_t index, uint32_t seed) {
    const float z = 1 - 2 * random_unit(index, 0, 0, seed), turn = 2 * pi * random_unit(index, 0, 1, seed);
    const float across = std::sqrt(std::max(0.0f, 1 - z * z));
    return {across * std::cos(turn), across * std::sin(turn), z};
}

inline vec3 random_point(uint32_t index, uint32_t seed, const Box& box) {
    return box.low + box.size() * vec3(random_unit(index, 1, 0, seed), random_unit(index, 1, 1, seed),
                                       random_unit(index, 1, 2, seed));
}
}

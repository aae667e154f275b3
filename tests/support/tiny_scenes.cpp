#include "support/tiny_scenes.h"

#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "volume/bricks/bricks.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall::test {
Medium even_fog(float extinction, Box box, Phase phase) {
    Medium medium;
    medium.name = "even";
    medium.optics = {extinction, vec3(1), phase, vec3(0)};
    medium.bounds = medium.world_bounds = box;
    return medium;
}

Light sun(vec3 direction, float lux) {
    Light light;
    light.name = "sun", light.kind = LightKind::sun;
    light.direction = glm::normalize(direction), light.intensity = vec3(lux);
    return light;
}

Light point_light(vec3 position, float candela) {
    Light light;
    light.name = "point", light.kind = LightKind::point, light.position = position, light.intensity = vec3(candela);
    return light;
}

Snapshot scene_of(std::vector<Medium> media, std::vector<Light> lights, vec3 ambient) {
    Snapshot snapshot;
    snapshot.media = std::move(media), snapshot.lights = std::move(lights), snapshot.ambient = ambient;
    for (const Medium& medium : snapshot.media)
        if (!std::isinf(medium.world_bounds.low.x)) snapshot.bounds.grow(medium.world_bounds);
    if (snapshot.bounds.empty()) snapshot.bounds = Box{vec3(-10), vec3(10)};
    return snapshot;
}

SparseVolume unit_grid(int n, const std::function<float(vec3)>& value) {
    SparseVolume volume;
    volume.index_to_world = glm::scale(dmat4(1), dvec3(1.0 / n));
    volume.index_to_world[3] = glm::dvec4(0.5 / n, 0.5 / n, 0.5 / n, 1);
    volume.active_low = ivec3(0), volume.active_high = ivec3(n - 1);
    for (int x = 0; x < n; x += 8)
        for (int y = 0; y < n; y += 8)
            for (int z = 0; z < n; z += 8) {
                Leaf leaf{{x, y, z}, {}};
                for (int i = 0; i < 512; ++i) {
                    const ivec3 voxel = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8);
                    leaf.values[i] = value((vec3(voxel) + 0.5f) / static_cast<float>(n));
                }
                volume.leaves.push_back(leaf);
            }
    return volume;
}

Medium grid_fog(float extinction, const SparseVolume& volume) {
    Medium medium;
    medium.name = "grid", medium.kind = DensityKind::bricks;
    medium.optics = {extinction, vec3(1), {PhaseKind::isotropic, 0}, vec3(0)};
    medium.bricks = make_bricks(volume);
    medium.world_bounds = medium.bounds = medium.bricks->bounds;
    return medium;
}

Stage stage_of(std::vector<Medium> media, std::vector<Light> lights, std::vector<Mesh> meshes, vec3 ambient) {
    Stage stage;
    stage.scene = std::make_shared<Scene>();
    stage.scene->materials = {blend_material(0.5f)};
    for (Mesh& mesh : meshes) add_mesh(*stage.scene, std::move(mesh));
    stage.snapshot = scene_of(std::move(media), std::move(lights), ambient);
    stage.snapshot.scene = stage.scene.get();
    stage.snapshot.occluders = Occluders::make(*stage.scene, 0, nullptr);
    return stage;
}

Mesh shade(float edge, float y) { return quad({edge - 50, y, -50}, {50, 0, 0}, {0, 0, 100}); }
}

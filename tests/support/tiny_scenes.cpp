#include "support/tiny_scenes.h"

#include "scene/scene.h"

namespace tyndall::test {
TestScene make_scene(std::vector<Medium> media, std::vector<Light> lights, std::vector<Mesh> meshes, vec3 ambient) {
    TestScene stage;
    stage.scene = std::make_shared<Scene>();
    stage.scene->materials = {blend_material(0.5f)};
    for (Mesh& mesh : meshes) add_mesh(*stage.scene, std::move(mesh));
    stage.snapshot = snapshot_of(std::move(media), std::move(lights), ambient);
    add_surfaces(*stage.scene, stage.snapshot);
    return stage;
}

Mesh roof(float edge, float y) { return quad({edge - 50, y, -50}, {50, 0, 0}, {0, 0, 100}); }
}

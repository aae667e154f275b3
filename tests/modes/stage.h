// Tiny scenes with surfaces.
#pragma once
#include "tiny_scenes.h"

#include "trace/scene_fixtures.h"

namespace tyndall::test {
// A snapshot with triangles; keeps their scene.
struct Stage {
    std::shared_ptr<Scene> scene = std::make_shared<Scene>();
    Snapshot snapshot;
};

inline Stage stage_of(std::vector<Medium> media, std::vector<Light> lights, std::vector<Mesh> meshes,
                      vec3 ambient = vec3(0)) {
    Stage stage;
    stage.scene->materials = {blend_material(0.5f)};
    for (Mesh& mesh : meshes) add_mesh(*stage.scene, std::move(mesh));
    stage.snapshot = scene_of(std::move(media), std::move(lights), ambient);
    stage.snapshot.scene = stage.scene.get();
    stage.snapshot.occluders = Occluders::make(*stage.scene, 0, nullptr);
    return stage;
}

// Opaque over x < edge at height y, far out to the other sides.
inline Mesh shade(float edge, float y) { return quad({edge - 50, y, -50}, {50, 0, 0}, {0, 0, 100}); }
}

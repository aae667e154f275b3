// Small scenes with surfaces.
#pragma once
#include "support/meshes.h"
#include "trace/small_scenes.h"

#include <memory>

namespace tyndall::test {
// A snapshot with triangles; keeps their scene.
struct TestScene {
    std::shared_ptr<Scene> scene;
    Snapshot snapshot;
};
TestScene make_scene(std::vector<Medium> media, std::vector<Light> lights, std::vector<Mesh> meshes,
                     vec3 ambient = vec3(0));

// Opaque over x < edge at height y, far out to the other sides.
Mesh roof(float edge, float y);
}

// A small scene in memory: fog, a sun, a plane and two cameras.
#pragma once
#include "base/math.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <filesystem>
#include <memory>

namespace tyndall {
struct CameraSource;
struct LoadedScene;
struct Request;
struct Scene;
struct ViewState;
}

namespace tyndall::test {
CameraSource camera_source(const char* name, vec3 position, vec3 target);

std::shared_ptr<Scene> small_scene(const std::filesystem::path& file = "small.json");

// A scene that no file was read for, as if it had been.
LoadedScene loaded(const Scene& scene);
void take_scene(ViewState& state, const std::shared_ptr<Scene>& scene);

// What a line of the script does.
void act(ViewState& state, const char* line);

Request request_for(std::shared_ptr<Scene> scene, const char* mode = "march");
}

// Defaults for what a scene lacks: a camera that sees everything, light, fog.
#pragma once
#include "scene/scene.h"

namespace tyndall {
// Adds a camera that frames the scene when it has none, with a warning.
void add_missing_camera(Scene& scene);

// For a bare glTF: a sun when it has no light, and thin fog, each with a warning.
void add_missing_light_and_fog(Scene& scene);
}

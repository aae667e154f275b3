// Places of a scene that move.
#pragma once
#include "scene/scene.h"

namespace tyndall {
// Whether the scene gives keys to a node (-1 = none) or one above it.
bool is_moving(const Scene& scene, int node);
}

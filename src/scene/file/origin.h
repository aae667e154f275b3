// Scenes far from the world's origin, where floats are too coarse for them.
#pragma once
#include "scene/file/values.h"

namespace tyndall {
struct Scene;

// A place near the default camera at the start, or near what the glTF holds, where all places should be counted from;
// 0 for a scene near the world's origin. Asked after the glTF and before the rest of the scene file (`root`, empty for
// a bare glTF) is read.
dvec3 far_origin(const Field& root, const Scene& scene);
}

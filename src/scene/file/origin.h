// Scenes far from the world's origin, where float precision is too low.
#pragma once
#include "scene/file/values.h"

namespace tyndall {
struct Scene;

// The position that all others should be relative to: near the default camera at the start, or near the contents of the
// glTF; 0 for a scene near the world's origin. Call after reading the glTF and before the rest of the scene file
// (`root`, empty for a bare glTF).
dvec3 far_origin(const Field& root, const Scene& scene);
}

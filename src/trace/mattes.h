// Holdout objects (mattes): black with zero alpha to the camera, ordinary surfaces to lights.
#pragma once
#include "scene/scene.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
inline bool has_mattes(const Snapshot& snapshot) {
    return snapshot.scene && std::ranges::any_of(snapshot.scene->instances, &Instance::matte);
}

inline bool is_matte(const Snapshot& snapshot, int instance) {
    return snapshot.scene && instance >= 0 && snapshot.scene->instances[static_cast<size_t>(instance)].matte;
}
}

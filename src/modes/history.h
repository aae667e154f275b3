// What a mode keeps from one frame to the next.
#pragma once
#include "modes/settings.h"
#include "scene/light.h"
#include "trace/view.h"

#include <memory>
#include <vector>

namespace tyndall {
struct FroxelHistory; // of modes/froxel/history/froxel_history.h
struct Scene;
struct Snapshot;
struct FogBuffer; // of modes/fog_buffer.h

// Passed to prepare() frame after frame, empty before the first. A mode that stores something calls update_history()
// first.
struct History {
    int frames = 0; // since it was last cleared
    View view;      // of the last frame
    Settings settings;
    const Scene* scene = nullptr;
    std::vector<Light> lights;
    vec3 ambient{0}; // including the environment's mean
    std::shared_ptr<FroxelHistory> froxels;
    std::shared_ptr<const FogBuffer> buffer;
};

// Records the frame that begins. First clears the history if this frame does not continue the last one: another scene,
// image size, lens or settings, a camera cut, or a light that was switched, moved or reshaped. Returns the number of
// earlier frames it holds.
int update_history(History& history, const View& view, const Snapshot& snapshot, const Settings& settings);
}

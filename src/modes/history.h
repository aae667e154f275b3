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

// Handed to prepare() frame after frame, empty before the first. A mode that keeps something calls follow() first.
struct History {
    int frames = 0; // since it was empty
    View view;      // of the last frame
    Settings settings;
    const Scene* scene = nullptr;
    std::vector<Light> lights;
    vec3 ambient{0}; // with the environment's mean
    std::shared_ptr<FroxelHistory> froxels;
    std::shared_ptr<const FogBuffer> picture;
};

// Notes the frame that begins. The history is emptied first when this frame does not go on from the last one: another
// scene, picture size, lens or settings, a cut, or a light switched, moved on or shining another way. Returns the
// number of frames it reaches back.
int follow(History& history, const View& view, const Snapshot& snapshot, const Settings& settings);
}

// One picture: every pixel sample traced, shaded, fogged and filtered into layers.
#pragma once
#include "modes/mode.h"

#include <atomic>
#include <map>
#include <string>
#include <vector>

namespace tyndall {
// Pixels of the crop window. Colours are premultiplied linear Rec.709.
struct Layers {
    ivec2 display{0}, low{0}, size{0};          // full picture; where the pixels lie in it
    Image<vec3> color;                          // surfaces through fog plus fog light
    Image<float> alpha;                         // 1 - what shows of the background
    Image<float> depth;                         // planar z of the nearest opaque surface, metres; infinite = none
    Image<vec3> inscatter;                      // fog light alone
    Image<float> transmittance;                 // of the fog, eye to surface
    Image<float> validity;
    std::vector<std::pair<std::string, Image<vec3>>> lights;   // fog and surface light of each light, on request
};

struct FrameStats {
    double prepare_seconds = 0, render_seconds = 0;
    uint64_t camera_rays = 0, steps = 0;
    uint64_t non_finite = 0;                    // samples dropped
    ivec2 first_non_finite{-1};
};

struct FrameOptions {
    bool per_light = false;
    std::atomic<bool>* cancel = nullptr;        // set from outside to stop early (throws Error)
    std::function<void(double)> progress;       // 0..1, from any thread
};

Layers render_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options, FrameStats& stats);
}

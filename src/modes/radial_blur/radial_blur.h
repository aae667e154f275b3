// Where the radial blur sees the lights.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/radial_blur/settings.h"
#include "modes/settings.h"

namespace tyndall {
struct View;
struct Snapshot;
struct BlurLight {
    size_t index = 0; // in the snapshot
    vec2 position{0}; // in the picture, pixels
    float depth = 0;  // planar z, infinite for a sun
    float radius = 0; // of its bright disc, pixels
    float fade = 1;   // 1 in the picture, 0 far outside
    vec3 color{0};    // of its bright sky
    float share = 0;  // of all such lights, by luminance
};

// The lights in front of the camera that are not too far off screen.
std::vector<BlurLight> blur_lights(const View& view, const Snapshot& snapshot, const RadialBlurSettings& settings);

// 1 for a light in the picture; falls smoothly to 0 at `fade` half pictures outside it.
float blur_fade(vec2 position, ivec2 size, float fade);
}

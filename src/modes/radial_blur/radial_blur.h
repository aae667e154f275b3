// Positions of lights in the image for the radial blur.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/radial_blur/settings.h"
#include "modes/settings.h"

namespace tyndall {
struct View;
struct Snapshot;
struct BlurLight {
    size_t index = 0; // in the snapshot
    vec2 position{0}; // in the image, pixels
    float depth = 0;  // planar z, infinite for a sun
    float radius = 0; // of its bright disk, pixels
    float fade = 1;   // 1 inside the image, 0 far outside
    vec3 color{0};    // of its bright sky
    float share = 0;  // fraction of the luminance of all such lights
};

// The lights in front of the camera and not too far off screen.
std::vector<BlurLight> blur_lights(const View& view, const Snapshot& snapshot, const RadialBlurSettings& settings);

// 1 for a light inside the image; falls smoothly to 0 at `fade` half image sizes outside it.
float blur_fade(vec2 position, ivec2 size, float fade);
}

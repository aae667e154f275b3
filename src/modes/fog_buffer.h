// The fog of a picture, computed once for every n-th pixel and found again for any ray of the picture.
#pragma once
#include "modes/mode.h"
#include "modes/resolution.h"
#include "modes/settings.h"
#include "trace/view.h"

namespace tyndall {
// Fog between the eye and the first surface at the centres of pixels, of a size that is a share of the full one.
struct FogBuffer {
    View view; // of the full picture
    Image<Scatter> fog;
    Image<float> length;            // of the ray, metres
    std::vector<Image<vec3>> parts; // empty unless the view wants them
    Image<float> age;               // frames that make up a pixel
};

struct FogBufferOptions {
    Resolution share = Resolution::full;
    bool blur = false; // over 4×4 pixels of like depth, the period of an ordered jitter
};

// Wraps the ScatterFunction of a mode so that fog is computed for a FogBuffer and spread over the full picture with
// regard to depth (joint bilateral: Kopf et al. 2007); with a history it goes on from the last frame's picture where
// that shows the same place (Karis 2014). Rays that none of their four neighbours is like in length, and stretches that
// do not start at the eye, are computed as they are.
ScatterFunction from_fog_buffer(const View& view, const Snapshot& snapshot, const FogBufferOptions& options,
                                ScatterFunction whole, History* history);

// A share of a picture size, rounded up.
ivec2 shared_size(ivec2 size, Resolution share);

struct FogBuffer;
struct Medium;

// Averages every pixel with those of like length around it: weights ½ 1 1 1 ½ along each side hold every phase of a
// 4×4 pattern equally often.
void blur_pattern(FogBuffer& picture);

// Mixes in what the last frame's picture shows of the same fog: where the light of homogeneous fog comes from. The more
// its near and its far half move against each other the less is remembered.
void go_on_from(const FogBuffer& before, std::span<const Medium> media, FogBuffer& picture);
}

// Fog computed once per frame, at every n-th pixel, and interpolated for any camera ray.
#pragma once
#include "modes/mode.h"
#include "modes/resolution.h"
#include "modes/settings.h"
#include "trace/view.h"

namespace tyndall {
// Fog between the eye and the first surface at pixel centers of a full- or reduced-resolution image.
struct FogBuffer {
    View view; // of the full-resolution image
    Image<Scatter> fog;
    Image<float> length;            // of the ray, meters
    std::vector<Image<vec3>> parts; // empty unless View::fog_parts
    Image<float> age;               // frames accumulated in a pixel
};

struct FogBufferOptions {
    Resolution resolution = Resolution::full;
    bool blur = false; // over 4×4 pixels of similar ray length, the period of an ordered jitter
};

// Computes fog with `whole` into a FogBuffer and returns a function that upsamples it to any camera ray by joint
// bilateral filtering (Kopf et al. 2007). With a history, it blends in the last frame's reprojected buffer (temporal
// accumulation, Karis 2014). Rays with too few neighbors of similar length, and rays that do not start at the eye, are
// evaluated by `whole`. With a lens, returns `whole`.
ScatterFunction from_fog_buffer(const View& view, const Snapshot& snapshot, const FogBufferOptions& options,
                                ScatterFunction whole, History* history);

// An image size at a reduced resolution, rounded up.
ivec2 reduced_size(ivec2 size, Resolution resolution);

struct Medium;

// Averages each pixel with neighbors of similar ray length. The weights ½ 1 1 1 ½ along each side give every phase of a
// 4×4 pattern the same total weight.
void blur_pattern(FogBuffer& buffer);

// Blends in the last frame's fog, reprojected at the mean distance from which the light of homogeneous fog comes. The
// larger the parallax between the near and far half of that light, the lower the weight of the history.
void accumulate_fog(const FogBuffer& before, std::span<const Medium> media, FogBuffer& buffer);
}

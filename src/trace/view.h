// What is rendered: a camera, a picture size and how its pixels are sampled.
#pragma once
#include "scene/camera.h"
#include "trace/jitter.h"

#include <cstdint>

namespace tyndall {
enum class PixelFilter { box, tent, gaussian, blackman_harris, center };

struct View {
    Camera camera;
    ivec2 size{640, 360};            // the full picture (display window)
    ivec2 crop_low{0}, crop_high{0}; // pixels low..high (high excluded) to render; equal = all
    int pixel_samples = 4;
    int batches = 1; // independent groups of equally many samples, each with random numbers of its own
    PixelFilter filter = PixelFilter::blackman_harris;
    float filter_radius = 1.0f; // pixels
    Jitter jitter = Jitter::interleaved;
    bool per_light = false; // whether the parts of single lights are wanted
    uint32_t seed = 0;
    int frame = 0; // varies the jitter from frame to frame
};

// A sample as part of a low-discrepancy sequence: each pixel and batch has its own.
struct SamplePlace {
    uint32_t sequence; // names the sequence
    uint32_t index;    // place in it
};
SamplePlace sample_place(const View& view, ivec2 pixel, int sample);

// Position of a sample in its pixel, in pixels from the upper left of the picture: importance sampled by the filter, so
// every sample has weight one.
vec2 sample_position(const View& view, ivec2 pixel, int sample);
}

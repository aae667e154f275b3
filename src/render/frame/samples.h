// Camera rays of neighboring pixels traced through transparent surfaces and the fog between them.
#pragma once
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "trace/surface.h"

#include <atomic>
#include <span>
#include <vector>

namespace tyndall {
// What one camera ray sees.
struct PixelSample {
    vec3 surface{0}, background{0}, inscatter{0}; // the parts of its color; times the weight
    float weight = 1;                             // of the sample in its pixel
    float alpha = 0, transmittance = 1, validity = 1;
    vec3 channels{1};       // the transmittance of each channel
    float holdout = 0;      // share of the sample that mattes hold out
    float depth = infinity; // planar z of the first opaque surface
    float off_center = 0;   // squared distance of the ray from the pixel's center, pixels²
    int steps = 0;

    vec3 color() const { return surface + background + inscatter; }
    bool finite() const; // of everything but the depth
};

// All that the samples of a frame share.
struct FrameTracer {
    const View& view;
    const Snapshot& snapshot;
    const Prepared& prepared;
    Surfaces surfaces;    // shared or own: who shades them
    int light_points;     // per soft light, for shared surfaces
    bool covered = false; // whether alpha accounts for mattes that hold out a background (else see cover_background)
    std::atomic<double>* fog_seconds = nullptr; // adds up the time spent in the mode

    FrameTracer with(const View& other) const;
};
FrameTracer frame_tracer(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                         const Prepared& prepared);

// Calls the mode's scatter function, and measures its time if requested.
void scatter(const FrameTracer& tracer, const RayBatch& batch, std::span<Scatter> results);

// Traces sample `sample` of up to 16 pixels. `parts` is empty or receives pixels × part_count(lights).
void trace_samples(const FrameTracer& tracer, std::span<const ivec2> pixels, int sample, std::span<PixelSample> samples,
                   std::span<vec3> parts);
}

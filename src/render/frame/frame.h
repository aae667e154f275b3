// Renders an image: traces every pixel sample through surfaces and fog, and filters the samples into layers.
//
// A sample follows its camera ray through up to 64 BLEND surfaces to the first opaque one (or the 64th layer, taken as
// opaque), asking the mode for the fog of each segment in between. If nothing is hit, the fog ends at the camera's far
// plane or where the media end; unbounded media are followed until optical depth 20 or until less than 1e-6 of optical
// depth is left, at most 1e12 m. A segment may have length 0. An image and any crop of it hold the same bits, at any
// thread count.
//
// A mode with Surfaces::post gets the full image, also for a crop, and adds to it.
//
// A mode with Surfaces::own is asked once per sample, for the whole ray from the camera to the far plane; the renderer
// finds the surfaces for depth and alpha only.
#pragma once
#include "integrate/ray_batch.h"
#include "render/frame/layers.h"
#include "trace/lights/emission_surface.h"

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall {
struct History;
struct LightDepth;
struct Mode;
struct Settings;
struct Snapshot;
struct View;

// What a frame needs before its first ray.
struct Prepared {
    ScatterFunction scatter;
    std::vector<LightDepth> light_depths; // of every light, for shared surfaces; empty when there are none
    Emitters emitters{};                  // that light shared surfaces
    double mode_seconds = 0;              // taken to prepare the mode
    // For each moment of an open shutter; then the frame itself has no scatter function and no light depths, and
    // layer_of_light holds the frame's layer for each light of a moment.
    std::vector<Prepared> moments{};
    std::vector<int> layer_of_light{};
    // For red, green and blue in chromatic fog; each holds its channel's scene.
    std::vector<Prepared> channels{};
    std::shared_ptr<const Snapshot> channel{};
};

// Whether a frame has several moments: a camera for each in the view, and a scene for each in the snapshot.
bool has_moments(const View& view, const Snapshot& snapshot);

Prepared prepare_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                       History* history);

// Computes everything that a frame, and any part of it, needs before its first sample. The snapshot's cache folder
// stores it or records its cost.
void prepare_files(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings);

struct FrameOptions {
    bool halves = false;                  // whether to keep half_a and half_b
    History* history = nullptr;           // of the frames before; null = none
    std::atomic<bool>* cancel = nullptr;  // set from outside to stop early (throws Error)
    std::function<void(double)> progress; // 0..1, from any thread
    // Receives the predicted seconds of a goal: before long work, and again if that soon proves wrong.
    std::function<void(double)> forecast{};
    // If not null: prepared with the same settings and a view that differs in samples and seed only.
    std::shared_ptr<const Prepared> prepared{};
};

// The view whose image a mode with Surfaces::post works on; add_post() adds the mode's light and crops to `view`.
View view_before_post(const View& view);
void add_post(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, Layers& layers,
              FrameStats& stats);

// Sets alpha to 1 if the background is part of the image; with mattes, the samples account for it already.
void cover_background(const View& view, const Snapshot& snapshot, Layers& layers);

// Throws Error (internal) when cancelled.
Layers render_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options, FrameStats& stats);
}

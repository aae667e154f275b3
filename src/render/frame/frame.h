// One picture: every pixel sample traced, shaded, fogged and filtered into layers.
//
// A sample follows its camera ray through up to 64 BLEND surfaces to the first opaque one (or the 64th layer, taken as
// opaque), asking the mode for the fog of each stretch in between. Where nothing is hit, the fog ends at the camera's
// far plane or where the media end; media without end are followed until optical depth 20 or until less than 1e-6 is
// left, at most 1e12 m. A stretch may have length 0. A picture and any crop of it hold the same bits, at any thread
// count.
//
// A mode with Surfaces::post gets the full picture, also for a crop, and adds to it.
//
// A mode with Surfaces::own is asked once per sample, for the whole ray from the eye to the far plane; the renderer
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
    double mode_seconds = 0;              // what the mode took
    // Of each moment while the shutter is open; then the frame itself has neither fog nor depths, and lights of a
    // moment go into these of the frame's layers.
    std::vector<Prepared> moments{};
    std::vector<int> layer_of_light{};
    // Red, green and blue where fog dims them differently, and of each of them the scene as it meets it.
    std::vector<Prepared> channels{};
    std::shared_ptr<const Snapshot> channel{};
};

// Whether a frame is made of several moments: the view has a camera for each, and the snapshot a scene.
bool has_moments(const View& view, const Snapshot& snapshot);

Prepared prepare_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                       History* history);

// Makes all that a frame, and any part of it, makes before its first sample. The snapshot's files keep it, or note what
// it costs.
void prepare_files(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings);

struct FrameOptions {
    bool halves = false;                  // of the batches
    History* history = nullptr;           // of the frames before; null = none is kept
    std::atomic<bool>* cancel = nullptr;  // set from outside to stop early (throws Error)
    std::function<void(double)> progress; // 0..1, from any thread
    // Of what a goal will take, seconds: before long work, and again if that soon proves wrong.
    std::function<void(double)> forecast{};
    // Already, with the same settings and a view that differs in samples and seed only.
    std::shared_ptr<const Prepared> prepared{};
};

// A mode with Surfaces::post works on the image of this view, and adds to it what its own view shows.
View view_before_post(const View& view);
void add_post(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, Layers& layers,
              FrameStats& stats);

// Alpha is 1 where the background is part of the image; with mattes its samples have seen to that already.
void cover_background(const View& view, const Snapshot& snapshot, Layers& layers);

// Throws Error (internal) when cancelled.
Layers render_frame(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options, FrameStats& stats);
}

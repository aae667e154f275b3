// What all tiles of a frame share, and the loop over them. For the files of this folder only.
#pragma once
#include "render/frame/frame.h"
#include "render/frame/samples.h"

namespace tyndall {
// What all blocks of a frame share.
struct FrameTask {
    std::shared_ptr<const Prepared> prepared;         // kept alive for the tracer
    std::shared_ptr<std::atomic<double>> fog_seconds; // spent in the mode by all threads; kept alive for the tracer
    FrameTracer tracer;
    double mode_seconds = 0; // taken to prepare the mode
    Layers layers;
    std::string made_by{}; // mode and settings, where the snapshot has files; else empty
    // Layers that receive the parts of inscatter, if requested; then channel_transmittance, if fog is chromatic.
    std::vector<Image<vec3>*> parts;
    size_t fog_parts = 0; // how many of these are parts of inscatter
    const std::atomic<bool>* cancel = nullptr;
};

FrameTask make_task(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options);

// Black layers of the view's crop window.
Layers make_layers(const View& view, bool halves);

// With an open shutter, parts of inscatter are indexed by layer, not by light: its moments may have different lights.
LightLayers light_layers(const Snapshot& snapshot);

// The layer of each light of a snapshot, which is the frame's or one of its moments'.
std::vector<int> layers_of_lights(const LightLayers& layers, const Snapshot& snapshot);

// Adds the layers, black. Returns where the parts of inscatter go: for each light, then ambient, emission and multiple.
std::vector<Image<vec3>*> add_light_layers(const LightLayers& lights, Layers& layers);

// Whether the frame has the layer channel_transmittance.
bool has_channel_layer(const Snapshot& snapshot);

// Sets the task's parts, adding layers for them. `lights`: empty unless the view requests them.
void find_parts(const View& view, const LightLayers& lights, FrameTask& task);

// The pixels of a tile inside the image, also those outside its crop, since a mode may share steps between neighbors.
struct PixelTile {
    ivec2 corner{0};
    ivec2 pixels[16];
    size_t count = 0;
};

bool contains(const Layers& layers, ivec2 pixel);

// Calls `render` for each tile that overlaps the layers, blocks of tiles in parallel, with the block's number and
// statistics. Returns the sum of the statistics. Throws Error (internal) when cancelled. If `sparse`, tiles have one
// pixel of each 2×2 of the layers.
FrameStats for_each_tile(const Layers& layers, const FrameOptions& options,
                         const std::function<void(const PixelTile&, int64_t block, FrameStats&)>& render,
                         bool sparse = false);

// Copies each pixel of sparse tiles to the others it stands for.
void spread_pixels(Layers& layers);
int64_t count_blocks(ivec2 low, ivec2 size);
}

// What all tiles of a frame share, and the loop over them. For the files of this folder only.
#pragma once
#include "render/frame/frame.h"
#include "render/frame/samples.h"

namespace tyndall {
inline constexpr int tile_side = 4; // a tile's 16 rays are traced together

// What all blocks of a frame share.
struct FrameTask {
    std::shared_ptr<const Prepared> prepared;         // held for the tracer
    std::shared_ptr<std::atomic<double>> fog_seconds; // of the mode, of all threads; held for the tracer
    FrameTracer tracer;
    double mode_seconds = 0; // its preparation
    Layers layers;
    std::string made_by{}; // mode and settings, where the snapshot has files; else empty
    // Of the layers: where the parts of fog light go, as many as asked for; then the channels' transmittance, where fog
    // is coloured.
    std::vector<Image<vec3>*> parts;
    size_t fog_parts = 0; // of these
    const std::atomic<bool>* cancel = nullptr;
};

FrameTask make_task(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                    const FrameOptions& options);

// Black layers of the view's crop window.
Layers make_layers(const View& view, bool halves);

// With an open shutter parts of fog light come by layer, not by light: lights of its moments may differ.
LightLayers light_layers(const Snapshot& snapshot);

// Which of the layers each light of a snapshot goes into: the frame's, or of one of its moments.
std::vector<int> layers_of_lights(const LightLayers& layers, const Snapshot& snapshot);

// Adds the layers, black. Where the parts of fog light go: for each light, then ambient, emission and multiple.
std::vector<Image<vec3>*> add_light_layers(const LightLayers& lights, Layers& layers);

// Whether the channels' transmittances are a layer of the frame.
bool tells_channels(const Snapshot& snapshot);

// Finds where the parts go, with layers made for them. `lights`: empty unless the view asks for them.
void find_parts(const View& view, const LightLayers& lights, FrameTask& task);

// The pixels of a tile that lie in the picture; those outside its crop too, since a mode may let neighbours share
// steps.
struct PixelTile {
    ivec2 corner{0};
    ivec2 pixels[16];
    size_t count = 0;
};

bool contains(const Layers& layers, ivec2 pixel);

// Calls `render` for each tile that shows in the layers, blocks of tiles in parallel, with the number of the block and
// statistics that only that block adds to. Returns those of all blocks. Throws Error (internal) when cancelled.
FrameStats for_each_tile(const Layers& layers, const FrameOptions& options,
                         const std::function<void(const PixelTile&, int64_t block, FrameStats&)>& render);
int64_t count_blocks(ivec2 low, ivec2 size);
}

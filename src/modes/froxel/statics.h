// Data that is reused from frame to frame while camera, surfaces and fog are static, whatever the lights do.
#pragma once
#include "modes/froxel/fill/fill.h"
#include "modes/froxel/settings.h"

namespace tyndall {
struct FroxelStatics {
    FroxelGrid grid; // with its slices
    FroxelTiles tiles;
    std::vector<Medium> media;
    std::shared_ptr<const Occluders> occluders;
    bool same_view = false, same_fog = false; // as in the previous frame: view and surfaces; those and fog
    bool same_froxels = false;                // froxels coincide with those of the previous frame
    int stood = 0;                            // number of frames with same_fog

    // Whether the history's extinction is its mean over all rays of each tile.
    bool settled() const { return stood >= 2 * static_cast<int>(tiles.rays()); }

    // Extinctions by ray of a tile (rays take turns from frame to frame), for fog that has been static for at least a
    // frame.
    std::vector<std::shared_ptr<const RecycledFloats>> extinctions;
};

// The statics of a frame, shared with those of the previous frame (may be null) where nothing has changed. `snapshot`:
// with the settings applied. The grid has no slices if no fog is in view.
FroxelStatics make_statics(const View& view, const Snapshot& snapshot, const FroxelSettings& settings,
                           const FroxelStatics* before);

// Same as fill_froxels(), but reuses stored extinctions, or stores them for later frames.
FroxelLight fill_still_froxels(const FroxelScene& scene, FroxelStatics& statics, FillPass pass);
}

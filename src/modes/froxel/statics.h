// What stays as it is from frame to frame while camera, surfaces and fog stand still, whatever the lights do.
#pragma once
#include "modes/froxel/fill/fill.h"
#include "modes/froxel/settings.h"

namespace tyndall {
struct FroxelStatics {
    FroxelGrid grid; // with its slices
    FroxelTiles tiles;
    std::vector<Medium> media;
    std::shared_ptr<const Occluders> occluders;
    bool same_view = false, same_fog = false; // as in the frame before; fog and what is seen of it
    bool same_froxels = false;                // each where one was in the frame before
    int stood = 0;                            // frames for which that has been so

    // Whether what is remembered of the fog is its mean over the rays of each tile.
    bool settled() const { return stood >= 2 * static_cast<int>(tiles.rays()); }

    // Extinctions by the turn of the tiles' rays, of fog that has stood still for a frame at least.
    std::vector<std::shared_ptr<const RecycledFloats>> extinctions;
};

// Reads a frame's scene with what is known of the frame before (null: nothing). `snapshot` as the settings
// see it. A grid without slices: no fog in view.
FroxelStatics look_at_scene(const View& view, const Snapshot& snapshot, const FroxelSettings& settings,
                            const FroxelStatics* before);

// As fill_froxels(), with the extinctions known or noted.
FroxelLight fill_still_froxels(const FroxelScene& scene, FroxelStatics& statics, FillPass pass);
}

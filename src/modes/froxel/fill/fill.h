// Light and extinction of every froxel.
#pragma once
#include "base/recycled.h"
#include "modes/froxel/beams/beam_shadows.h"
#include "modes/froxel/beams/beams.h"
#include "modes/froxel/settings.h"
#include "modes/froxel/tiles.h"
#include "modes/settings.h"
#include "trace/fluence/fluence.h"
#include "trace/shadows/intervals/shadow_slices.h"
#include "trace/shadows/volumes/shadow_view.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_grid.h"

#include <algorithm>

namespace tyndall {
// Data for filling, besides the grid, made once per frame.
struct FroxelScene {
    Snapshot snapshot; // media with the settings applied
    FroxelSettings settings;
    StyleSettings style;
    std::vector<Medium> sun_media;  // for sunlight: phase lobes no narrower than froxels; empty = the snapshot's
    std::vector<LightDepth> depths; // one per light
    std::vector<std::unique_ptr<const GridColumns>> columns; // of grids filled on demand; else null
    std::vector<ConeFalloff> cones;                          // one per light
    std::vector<NearLight> nears;                            // likewise; empty = none
    std::vector<size_t> beams; // the lights that look-ups integrate per ray, as far as they are near
    // With FroxelVisibility::intervals: shadow views from the grid's camera, for lights of which all lines see the same
    // point; shadow slices for other lights.
    std::vector<std::unique_ptr<const ShadowView>> views;
    std::vector<const ShadowSlices*> slices; // null where there are none; owned by the snapshot
    // Per light, shadow views for shadows found per camera ray; else empty.
    std::vector<LampViews> pixel_views;
    bool views_fit = true;                      // whether those fit in memory
    float pixel_margin = 0;                     // how far a ray may stray from its pixel, pixels
    std::shared_ptr<const FluenceGrid> fluence; // null = single scattering only

    bool has_exact_shadows(const Light& light) const {
        return tyndall::has_exact_shadows(light, snapshot, settings, views_fit);
    }
    bool has_pixel_views(size_t light) const { return light < pixel_views.size() && !pixel_views[light].empty(); }
    NearLight near(size_t light) const { return light < nears.size() ? nears[light] : NearLight{}; }
    // Whether all of a light is integrated per ray, and none of it in froxels.
    bool is_beam(size_t light) const { return std::isinf(near(light).radius); }
};

// Four floats per froxel, [tile · slices + slice]: light scattered and emitted towards the eye, per unit of extinction
// (red, green, blue), and extinction, 1/m. Froxels completely behind surfaces hold nothing.
struct FroxelLight {
    RecycledFloats values;
    const float* at(const FroxelGrid& grid, size_t tile, int slice) const {
        return values.data() + 4 * (tile * static_cast<size_t>(grid.slices()) + static_cast<size_t>(slice));
    }
    float* at(const FroxelGrid& grid, size_t tile, int slice) {
        return values.data() + 4 * (tile * static_cast<size_t>(grid.slices()) + static_cast<size_t>(slice));
    }
};

struct FillPass {
    int only = -1;                  // 0 or more: only this part of the light (see part_count)
    int frame = 0;                  // of the history: 0 samples the centers of froxels, later ones other points
    const uint8_t* stale = nullptr; // per froxel, 1 = keeps its history: only its extinction is found
    bool statics = false;           // stale froxels need no extinction either; tiles that are all stale may be skipped
    const float* known = nullptr;   // extinctions that an earlier pass with the same samples stored
    float* noted = nullptr;         // where to store them, extinction_count() floats
    FroxelBeams* beams = nullptr;   // where to store shares of beams; null = not wanted
};
size_t extinction_count(const FroxelScene& scene, const FroxelGrid& grid);

// Whether a froxel lies completely behind the surfaces that all rays of its tile hit.
inline bool is_hidden(const FroxelGrid& grid, const FroxelTiles& tiles, size_t tile, int slice) {
    return !(tiles.farthest[tile] > grid.faces[static_cast<size_t>(slice)]);
}

// Number of slices that some ray of a tile sees: those before the first hidden one.
inline size_t seen_slices(const FroxelGrid& grid, const FroxelTiles& tiles, size_t tile) {
    const auto behind = std::lower_bound(grid.faces.begin(), grid.faces.end() - 1, tiles.farthest[tile]);
    return static_cast<size_t>(behind - grid.faces.begin());
}

FroxelLight fill_froxels(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles,
                         const FillPass& pass);
}

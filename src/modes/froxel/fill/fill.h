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
// What filling needs besides the grid, made once per frame.
struct FroxelScene {
    Snapshot snapshot; // media as the settings see them
    FroxelSettings settings;
    StyleSettings style;
    std::vector<Medium> sun_media;  // in the light of suns: glows are no narrower than froxels. Empty = the snapshot's
    std::vector<LightDepth> depths; // one per light
    std::vector<std::unique_ptr<const GridColumns>> columns; // of their grids; null where there is none
    std::vector<ConeFalloff> cones;                          // one per light
    std::vector<NearLight> nears;                            // likewise; empty = none
    std::vector<size_t> beams; // the lights that look-ups follow ray by ray, as far as they are near
    // With FroxelVisibility::intervals: of each light that all lines see the same point of, its shadows as the grid's
    // camera sees them; and what shows those of other lights.
    std::vector<std::unique_ptr<const ShadowView>> views;
    std::vector<const ShadowSlices*> slices; // null where there are none; the snapshot's
    // Of each light that rays find the shadows of by themselves, its shadows as they see them; else empty.
    std::vector<LampViews> pixel_views;
    bool lamp_views_fit = true;                 // whether there is room for those
    float pixel_margin = 0;                     // how far a ray may stray from its pixel, pixels
    std::shared_ptr<const FluenceGrid> fluence; // null = light scatters once only

    bool has_pixel_views(size_t light) const { return light < pixel_views.size() && !pixel_views[light].empty(); }
    NearLight near(size_t light) const { return light < nears.size() ? nears[light] : NearLight{}; }
    // Whether nothing of a light is in the froxels' light.
    bool is_beam(size_t light) const { return std::isinf(near(light).radius); }
};

// Four floats per froxel, [tile · slices + slice]: the light that its fog sends towards the eye, per unit of
// extinction (red, green, blue), and the extinction per metre. Froxels wholly behind surfaces hold nothing.
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
    int only = -1;                  // 0..: this part of the light alone (see part_count)
    int frame = 0;                  // of the history: 0 looks at the centres, later ones elsewhere in the froxels
    const uint8_t* stale = nullptr; // per froxel, 1 = its light is remembered: find its extinction only
    bool statics = false;           // stale froxels need no extinction either; tiles all stale may be left as they are
    const float* known = nullptr;   // extinctions as an earlier pass of this frame's looks has noted them
    float* noted = nullptr;         // where to note them, extinction_count() floats
    FroxelBeams* beams = nullptr;   // where to put what is kept of the beams; null = not wanted
};
size_t extinction_count(const FroxelScene& scene, const FroxelGrid& grid);

// Whether a froxel lies wholly behind what all rays of its tile meet.
inline bool is_hidden(const FroxelGrid& grid, const FroxelTiles& tiles, size_t tile, int slice) {
    return !(tiles.farthest[tile] > grid.faces[static_cast<size_t>(slice)]);
}

// Slices of which some ray of a tile sees something: those before the first hidden one.
inline size_t seen_slices(const FroxelGrid& grid, const FroxelTiles& tiles, size_t tile) {
    const auto behind = std::lower_bound(grid.faces.begin(), grid.faces.end() - 1, tiles.farthest[tile]);
    return static_cast<size_t>(behind - grid.faces.begin());
}

FroxelLight fill_froxels(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles,
                         const FillPass& pass);
}

// What the eye sees through each tile of froxels: a few rays per tile up to the first opaque surface.
#pragma once
#include "modes/froxel/grid.h"

namespace tyndall {
struct Snapshot;

struct FroxelTiles {
    std::vector<vec2> offsets;    // offsets of a tile's rays from its center, in tiles; the first is 0
    std::vector<float> depth;     // [tile · rays + ray]: planar depth of the surface, infinite where there is none
    std::vector<float> nearest;   // per tile, of its rays
    std::vector<float> farthest;  // likewise: what lies beyond is hidden
    std::vector<int32_t> deepest; // per tile, the ray that sees farthest

    // Set by set_trust(). A tile's sums have weight 1 up to the planar depth `trusted`; beyond, it falls by
    // `trust_falloff` per meter.
    std::vector<float> trusted, trust_falloff;
    std::vector<float> trusted_around; // minimum of `trusted` over the 4×4 tiles at offsets -1 to 2

    size_t rays() const { return offsets.size(); }
};

// Traces the tiles' rays. A tile of one pixel has one ray, through its center.
FroxelTiles make_froxel_tiles(const FroxelGrid& grid, const Snapshot& snapshot);

// Sets how far each tile's sums can be used for pixels that see farther than its rays: at full weight slightly beyond
// its farthest surface, then falling to 0 over the depth range of its surfaces, at least a slice.
void set_trust(const FroxelGrid& grid, FroxelTiles& tiles);

// Planar depths that slices have to cover: from the nearest fog to the farthest that a tile sees, but for unbounded fog
// only to the end of the scene; `end` exceeds `far` where unbounded fog is visible behind the scene. Empty (far <=
// near) without fog.
struct FogDepths {
    float near = infinity, far = 0, end = 0;
};
FogDepths fog_depths(const FroxelGrid& grid, const FroxelTiles& tiles, const Snapshot& snapshot);
}

// What the eye sees through each tile of froxels: a few rays per tile up to the first opaque surface.
#pragma once
#include "modes/froxel/grid.h"

namespace tyndall {
struct Snapshot;

struct FroxelTiles {
    std::vector<vec2> offsets;    // of a tile's rays from its centre, in tiles; the first is the centre itself
    std::vector<float> depth;     // [tile · rays + ray]: planar depth of the surface, infinite where there is none
    std::vector<float> nearest;   // per tile, of its rays
    std::vector<float> farthest;  // likewise: what lies beyond is hidden
    std::vector<int32_t> deepest; // per tile, the ray that sees farthest

    // Made when the slices are known. A tile's sums are worth 1 up to `trusted`, then less by `distrust` per metre.
    std::vector<float> trusted, distrust;
    std::vector<float> trusted_around; // least `trusted` of the 4×4 tiles from one before to two behind

    size_t rays() const { return offsets.size(); }
};

// Traces the tiles. One pixel wide, a tile has one ray, through its centre.
FroxelTiles make_froxel_tiles(const FroxelGrid& grid, const Snapshot& snapshot);

// How far each tile's sums can be used for pixels that see farther: fully a little beyond what it sees, as its rays are
// samples, then less and less over as much again as its surfaces are deep, or a slice.
void set_trust(const FroxelGrid& grid, FroxelTiles& tiles);

// Planar depths that slices have to cover: from the nearest fog to the farthest that a tile sees or to the end of the
// scene; `end` is beyond `far` where the eye sees unbounded fog behind the scene. Empty (far <= near) without fog.
struct FogDepths {
    float near = infinity, far = 0, end = 0;
};
FogDepths fog_depths(const FroxelGrid& grid, const FroxelTiles& tiles, const Snapshot& snapshot);
}

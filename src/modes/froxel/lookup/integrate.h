// Froxels added up from the eye outwards.
#pragma once
#include "modes/froxel/fill/fill.h"

namespace tyndall {
// Per tile and face of the slices, front to back [tile · faces + face]: light that reaches the eye from before the face
// (red, green, blue), and the optical depth up to it per metre of slant: times |step of a line| it is the line's own.
struct FroxelSums {
    RecycledFloats values;
    const float* at(const FroxelGrid& grid, size_t tile, int face) const {
        return values.data() + 4 * (tile * grid.faces.size() + static_cast<size_t>(face));
    }
};

// Within a slice light and extinction are constant and the integral is exact (Hillaire 2015): L += T J (1-e^-D). Beyond
// what a tile sees, the last froxel it does see goes on.
FroxelSums integrate_froxels(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& light,
                             float view_depth);
}

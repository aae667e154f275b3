// Integration of froxels, front to back.
#pragma once
#include "modes/froxel/fill/fill.h"

namespace tyndall {
// Per tile and slice face, front to back [tile · faces + face]: light that reaches the eye from in front of the face
// (red, green, blue), and optical depth up to it for a slant of 1: multiply by |step| of a line for the line's own.
struct FroxelSums {
    RecycledFloats values;
    const float* at(const FroxelGrid& grid, size_t tile, int face) const {
        return values.data() + 4 * (tile * grid.faces.size() + static_cast<size_t>(face));
    }
};

// Light and extinction are constant in a slice, and the integral is exact (Hillaire 2015): L += T J (1-e^-D). Behind
// what a tile sees, its last visible froxel is repeated.
FroxelSums integrate_froxels(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& light,
                             float view_depth);
}

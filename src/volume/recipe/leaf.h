// The vector kernels that grow a recipe on its voxel grid.
#pragma once
#include "volume/recipe/field.h"

#include <span>

namespace tyndall {
// Fills one leaf whose voxel centres have these coordinates (relative to the field's origin).
// Returns how many voxels had to be computed to the last octave.
int fill_leaf(const FogField& field, const float* x, const float* y, const float* z, std::span<float, 512> values);

// The same of a recipe with a fire, and its temperatures.
int fill_leaf(const FogField& field, const float* x, const float* y, const float* z, std::span<float, 512> values,
              std::span<float, 512> kelvin);

// Sixteen boxes, by axis; the result has a bit for every box that can hold fog.
struct FogBoxes {
    float low[3][16], high[3][16];
};

uint32_t boxes_with_fog(const FogField& field, const FogBoxes& boxes);
}

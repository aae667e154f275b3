// SIMD kernels that evaluate a recipe on its voxel grid.
#pragma once
#include "volume/recipe/field.h"

#include <span>

namespace tyndall {
// Fills one leaf whose voxel centers have these coordinates (relative to the field's origin).
// Returns how many voxels needed all octaves.
int fill_leaf(const FogField& field, const float* x, const float* y, const float* z, std::span<float, 512> values);

// The same for a recipe with a fire, including temperatures.
int fill_leaf(const FogField& field, const float* x, const float* y, const float* z, std::span<float, 512> values,
              std::span<float, 512> kelvin);

// Sixteen boxes, by axis.
struct FogBoxes {
    float low[3][16], high[3][16];
};

uint32_t boxes_with_fog(const FogField& field, const FogBoxes& boxes);
}

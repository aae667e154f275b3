// Quadrature nodes for field emission along a ray, placed per voxel cell, independent of ray-marching steps.
#pragma once
#include "base/math.h"

#include <functional>

namespace tyndall {
struct BrickPool;

// A segment of the ray within a voxel cell.
struct EmissionCell {
    double low = 0, high = 0;
    float most = 0, least = 0; // range of the luminance at the cell's corners, relative to the field's maximum of 1
};

// Calls add(cell) in order for the cells on 0..t_max, in bricks whose maximum exceeds `faint`.
void find_emission_cells(const BrickPool& luminance, const Ray& ray, float faint,
                         const std::function<void(const EmissionCell&)>& add);

// A point on the ray and the length it represents, meters.
struct EmissionNode {
    float t = 0, length = 0;
};

// Calls add(node) for Gauss points in every cell, ascending, with more points where the light varies strongly. The
// error is below 2 % for light that falls by a factor of e^12 across a cell, and 0.3 % for e^2. Skips bricks below a
// millionth of the brightest.
void find_emission_nodes(const BrickPool& luminance, const Ray& ray, const std::function<void(EmissionNode)>& add);
}

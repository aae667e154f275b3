// Where the light of a field is asked for along a ray: voxel cell by voxel cell, free of the steps of whoever asks.
#pragma once
#include "base/math.h"

#include <functional>

namespace tyndall {
struct BrickPool;

// A stretch of the ray within a voxel cell.
struct EmissionCell {
    double low = 0, high = 0;
    float most = 0, least = 0; // luminance at the cell's corners, its maximum 1: between them it is no brighter
};

// Calls add(cell) for the cells of a ray on 0..t_max in order, in bricks brighter than `faint` anywhere.
void find_emission_cells(const BrickPool& luminance, const Ray& ray, float faint,
                         const std::function<void(const EmissionCell&)>& add);

// A place on the ray and the length that it stands for, metres.
struct EmissionNode {
    float t = 0, length = 0;
};

// Calls add(node) for Gauss points in every cell, ascending, more in cells across which the light changes by much.
// Light that falls by a factor of e^12 across a cell is off by less than 2 %, by e^2 .3 %; left out are bricks a
// millionth as bright as the brightest.
void find_emission_nodes(const BrickPool& luminance, const Ray& ray, const std::function<void(EmissionNode)>& add);
}

// Grids of optical depth, from fitting to filling.
#pragma once
#include "trace/light_depth.h"

#include <span>

namespace tyndall {
// A grid fitted to the brick media, without its depths; size 0 when the light reaches none of them. `resolution`: cells
// across the longer side of the fog as the light sees it; along the light they are about as long as wide.
LightDepthGrid fitted_grid(std::span<const Medium* const> media, const Light& light, int resolution);

// Integrates the media along the columns of a fitted grid, in parallel over columns.
void fill_grid(std::span<const Medium* const> media, LightDepthGrid& grid);
}

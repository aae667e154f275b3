// Grids of optical depth, from fitting to filling.
#pragma once
#include "trace/light_depth.h"

#include <span>

namespace tyndall {
// A grid of the light's kind fitted to the brick media, with empty cells; size 0 when the light reaches none of them.
LightDepthGrid fitted_grid(std::span<const Medium* const> media, const Light& light, int resolution);

// Integrates the media along the columns of a fitted grid. `start` is the distance along w of the first corner, `step`
// the one between corners.
void fill_grid(std::span<const Medium* const> media, LightDepthGrid& grid);
}

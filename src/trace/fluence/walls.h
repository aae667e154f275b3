// Surfaces between the cells of a fluence grid, across which light is not interpolated.
#pragma once
#include "trace/fluence/fluence.h"
#include "trace/occlusion/occluders.h"

namespace tyndall {
// Where light flies within cells, [8 · cell + octant]: w = ∫ luminance, xyz = ∫ luminance · position (in cells).
using FluenceOctants = std::vector<vec4>;

// Sets the grid's walls and cuts. A cell cut by a surface keeps the light of its brighter side, as if the whole cell
// lay there; so does `difference`. On entry, `grid.values` are means over whole cells.
void find_walls(const Occluders& occluders, const FluenceOctants& octants, FluenceGrid& grid,
                std::vector<float>& difference);
}

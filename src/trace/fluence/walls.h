// Surfaces between the cells of a grid of fluence: light is not mixed across them.
#pragma once
#include "trace/fluence/fluence.h"
#include "trace/occlusion/occluders.h"

namespace tyndall {
// Where in the cells light flew, [8 · cell + octant]: ∫ luminance, w, and of places (in cells) times it.
using FluenceOctants = std::vector<vec4>;

// Sets the grid's walls and cuts. Of a cell that a surface cuts, the light of the brighter side stays, as if
// all the cell lay there; of `difference` as well. `grid.values` are means over whole cells.
void find_walls(const Occluders& occluders, const FluenceOctants& octants, FluenceGrid& grid,
                std::vector<float>& difference);
}

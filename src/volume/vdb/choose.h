// Selects the grids of a file that a scene refers to.
#pragma once
#include "volume/vdb/file/prewalk.h"

#include <span>
#include <string>
#include <vector>

namespace tyndall {
// File and grid, for messages.
std::string label(const ByteCursor& file, const VdbGridEntry& grid);

// Why a grid cannot be used as fog, or as another quantity; empty if it can. `width`: fog width of a level set, 0 if
// none is given.
std::string grid_problem(const VdbGridEntry& grid, float width = 0, std::string_view quantity = "density");

// The key of a grid in scenes: its name, with an index if several share the name or it is empty.
std::string key_of(const VdbDirectory& directory, const VdbGridEntry& grid);

// The default if no grid is named: the first usable grid named "density"; else the only usable grid whose name does not
// suggest another quantity, or the only one of these with class fog volume; else null.
const VdbGridEntry* default_grid(const VdbDirectory& directory);

// The grid to read as fog: by name or name[index], or default_grid() if `wanted` is empty. Throws Error (refused),
// listing the grids for an unknown name. `quantity` is what errors call it.
const VdbGridEntry& choose_grid(const VdbDirectory& directory, const std::string& wanted, float width,
                                const ByteCursor& file, std::string_view quantity);

// Whether a file has all the grids that names stand for.
bool has_grids_called(const VdbDirectory& directory, std::span<const std::string> names);

// The grids of a color's or a velocity's components: a single one for a vector or gray grid. `quantity` is what errors
// call it. Throws Error (refused).
std::vector<const VdbGridEntry*> color_grids(const VdbDirectory& directory, std::span<const std::string> names,
                                             const ByteCursor& file, std::string_view quantity);
}

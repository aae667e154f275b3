// Which grids of a file are meant.
#pragma once
#include "volume/vdb/prewalk.h"

#include <span>
#include <string>
#include <vector>

namespace tyndall {
// The file and the grid, for messages.
std::string label(const ByteCursor& file, const VdbGridEntry& grid);

// Why a grid cannot be fog; empty when it can. `width`: that of a level set as fog, 0 where none is given.
std::string obstacle(const VdbGridEntry& grid, float width = 0);

// What a scene calls a grid: its name, with an index where several have the name or it has none.
std::string key_of(const VdbDirectory& directory, const VdbGridEntry& grid);

// What is taken when no grid is named: the first density; else the only one that can be fog and is not called something
// else, or is alone of class fog volume; null when there is none such.
const VdbGridEntry* fog_of(const VdbDirectory& directory);

// The grid to read as fog, by name or name[index], or fog_of(). Throws Error (refused): an unknown name lists what is
// there.
const VdbGridEntry& choose_grid(const VdbDirectory& directory, const std::string& wanted, float width,
                                const ByteCursor& file);

// Of a colour: the grids of its channels, one where it is a grid of vectors or grey. Throws Error (refused).
std::vector<const VdbGridEntry*> color_grids(const VdbDirectory& directory, std::span<const std::string> names,
                                             const ByteCursor& file);
}

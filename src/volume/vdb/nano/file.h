// NanoVDB files as a directory of grids, and the plain bytes of each.
#pragma once
#include "volume/bricks/leaf_memory.h"
#include "volume/vdb/prewalk.h"

namespace tyndall {
// Whether a file is one; the cursor stays where it is.
bool is_nanovdb(ByteCursor& file);

// The description of every grid. Throws Error (refused) for what is not a whole file of a version that can be read.
VdbDirectory read_nano_directory(ByteCursor& file);

// The grid.nano_bytes of a grid, unpacked. Throws Error (refused) when they do not unpack to that.
LargeBytes unpacked_grid(ByteCursor& file, const VdbGridEntry& grid);
}

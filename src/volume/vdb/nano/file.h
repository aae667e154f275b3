// The directory of grids in a NanoVDB file, and the decompressed bytes of each.
#pragma once
#include "volume/bricks/leaf_memory.h"
#include "volume/vdb/file/prewalk.h"

namespace tyndall {
// True for a NanoVDB file; does not move the cursor.
bool is_nanovdb(ByteCursor& file);

// The description of every grid. Throws Error (refused) unless the file is complete and of a supported version.
VdbDirectory read_nano_directory(ByteCursor& file);

// The grid.nano_bytes decompressed bytes of a grid. Throws Error (refused) if decompression fails.
LargeBytes unpacked_grid(ByteCursor& file, const VdbGridEntry& grid);
}

// The tree of a NanoVDB grid: nodes that point to each other, every one of which is checked to lie in the grid.
#pragma once
#include "volume/vdb/codec.h"

namespace tyndall {
// Decodes unpacked_grid() and counts what it holds. Throws Error (refused) naming `where`.
DecodedTree decode_nano_tree(std::string_view bytes, const VdbGridEntry& grid, VdbTreeCounts& counts,
                             const std::string& where, int component = 0);
}

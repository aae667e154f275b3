// Decodes the tree of a NanoVDB grid, checking that every node it points to lies within the grid.
#pragma once
#include "volume/vdb/library/codec.h"

namespace tyndall {
// Decodes the bytes of unpacked_grid() and fills `counts`. Throws Error (refused, out_of_memory) naming `where`.
DecodedTree decode_nano_tree(std::string_view bytes, const VdbGridEntry& grid, VdbTreeCounts& counts,
                             const std::string& where, int component = 0);
}

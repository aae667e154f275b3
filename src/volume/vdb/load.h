// Loads whole grids of a file: what reading a volume and describing it share.
#pragma once
#include "base/error.h"
#include "volume/vdb/library/codec.h"

#include <new>

namespace tyndall {
// The directory of a file that has grids. Throws Error (refused).
VdbDirectory read_grids(ByteCursor& file);

// Reads the bytes of a tree once, and validates, counts and decodes the same bytes in memory. Throws Error.
DecodedTree load_tree(ByteCursor& file, const VdbDirectory& directory, const VdbGridEntry& grid, VdbTreeCounts& counts,
                      int component = 0);

// A cleaned volume from one tree; adds its corrections to the report.
SparseVolume cleaned_volume(DecodedTree tree, const VdbGridEntry& grid, const ByteCursor& file, VdbReadReport& report);

// Reports a failed allocation as an Error.
template<class Body> auto within_memory(const std::filesystem::path& path, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        fail(ExitCode::out_of_memory, path.string(), "does not fit into memory");
    }
}
}

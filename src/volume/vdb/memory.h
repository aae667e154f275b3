// How much memory a tree takes, and whether there is as much.
#pragma once
#include "volume/vdb/prewalk.h"

namespace tyndall {
// Bytes of the library's tree, whose leaves hold no values, and of ours, which stand side by side for a moment.
uint64_t memory_needed(const VdbTreeCounts& counts);

// Throws Error (out_of_memory) naming `where` when this process cannot hope for so many bytes.
void check_memory(uint64_t bytes, const std::string& where);
}

// Estimates the memory of a tree and checks that it is available.
#pragma once
#include "volume/vdb/file/prewalk.h"

namespace tyndall {
// Bytes of the library's tree (leaves without values) and of the decoded tree, which coexist briefly.
uint64_t memory_needed(const VdbTreeCounts& counts);

// Throws Error naming `where` if a tree of these counts, decoded from `bytes` bytes, has more tiles than are supported
// (refused) or needs more memory than is available (out_of_memory).
void check_tree(const VdbTreeCounts& counts, uint64_t bytes, const std::string& where);

// Throws Error (out_of_memory) naming `where` if this process cannot allocate that many bytes.
void check_memory(uint64_t bytes, const std::string& where);
}

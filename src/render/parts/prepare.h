// Data that all parts of a frame would compute again, computed once and put into the folder next to the plan
// (manifest.h).
#pragma once
#include "render/parts/manifest.h"

#include <vector>

namespace tyndall {
struct Scene;

// Opens the plan's folder for writing and removes leftovers of killed runs. `most`: bytes that all its files may take.
// Throws Error (unwritable).
std::shared_ptr<CacheFolder> open_to_prepare(const SavedPlan& plan, uint64_t most);

// Writes a frame's files and then its manifest. Returns the cost of each item for a part that does not find it. Throws
// Error.
std::vector<CacheCost> prepare_for_parts(const Scene& scene, const SavedPlan& plan, int frame,
                                         const std::shared_ptr<CacheFolder>& folder);

// Removes from the plan's folder what no frame of the plan needs, or everything. Returns the number of bytes freed.
// Throws Error (unreadable, refused, unwritable).
uint64_t clean_prepared(const SavedPlan& plan, bool all);
}

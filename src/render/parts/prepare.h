// What all parts of a frame would make anew, made once and put into the folder beside the plan (manifest.h).
#pragma once
#include "render/parts/manifest.h"

#include <vector>

namespace tyndall {
struct Scene;

// The plan's folder, to add to. Leftovers of killed runs are removed. `most`: bytes that all its files may take. Throws
// Error (unwritable).
std::shared_ptr<CacheFolder> open_to_prepare(const SavedPlan& plan, uint64_t most);

// Makes a frame's files and then its manifest. Returns what each thing costs a part that does not find it. Throws
// Error.
std::vector<CacheCost> prepare_for_parts(const Scene& scene, const SavedPlan& plan, int frame,
                                         const std::shared_ptr<CacheFolder>& folder);

// Removes from the plan's folder what no frame of the plan needs, or all. Returns how many bytes that frees. Throws
// Error (unreadable, refused, unwritable).
uint64_t clean_prepared(const SavedPlan& plan, bool all);
}

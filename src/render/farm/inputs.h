// Every file that a job reads.
#pragma once
#include "volume/vdb/sequence.h"

namespace tyndall {
struct Scene;

// Scene, models, images, recipes, and the volumes of these frames; absolute, sorted, each once. Throws Error
// (unreadable) for a volume that is missing.
std::vector<std::filesystem::path> input_files(const Scene& scene, const std::vector<int>& frames,
                                               MissingFrame missing);
}

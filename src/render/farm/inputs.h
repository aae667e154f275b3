// Every file that a job reads.
#pragma once
#include <filesystem>
#include <vector>

namespace tyndall {
struct RenderRequest;
struct Scene;

// Scene, models, images, recipes, and the volumes that these frames show with the request's shutter; absolute, sorted,
// without duplicates. Throws Error (unreadable) for a volume that is missing.
std::vector<std::filesystem::path> input_files(const Scene& scene, const std::vector<int>& frames,
                                               const RenderRequest& request);
}

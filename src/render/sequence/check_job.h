// What can be said about a request before any frame is loaded.
#pragma once
#include "render/sequence/job.h"

namespace tyndall {
struct Mode;
struct Scene;

inline std::filesystem::path png_name(const std::string& exr) {
    return std::filesystem::path(exr).replace_extension(".png");
}

// Tests picture size, layers, names, directories and the target error, and removes leftovers of killed runs. Nothing
// that was read may be written over. Throws Error (usage, unwritable).
void check_job(const Scene& scene, const RenderRequest& request, const Mode& mode);
}

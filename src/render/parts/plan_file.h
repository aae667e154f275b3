// A plan as a file: all that decides the bits of frames, for as many machines as there are.
#pragma once
#include "render/sequence/job.h"

#include <filesystem>
#include <string>

namespace tyndall {
struct Scene;

struct SavedPlan {
    RenderRequest request; // without output; its frames are those of the plan, its grouping the plan's
    RenderPlan plan;
    std::vector<std::string> inputs; // content hashes of the scene's own files
    std::string build;               // of the program that made it
};

// Groups and leaves for so many samples a pixel: eight groups, fewer below eight samples; as many leaves, a power of
// two up to eight, as a group has samples. Raises the samples to a multiple of the groups.
Grouping grouping_of(int& samples);

// Names this program: plans are only rendered by the build that made them.
std::string build_name();

// Throws Error (unwritable).
void save_plan(const std::filesystem::path& file, const Scene& scene, const SavedPlan& plan);

// Throws Error (unreadable, refused): not a plan, or one of another version or build.
SavedPlan load_plan(const std::filesystem::path& file);

// Throws Error (refused) where the scene's files are not those that were planned for.
void check_inputs(const SavedPlan& plan, const Scene& scene);
}

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

// So many groups for so many samples a pixel, fewer where those are fewer; as many leaves, a power of two, as a group
// has samples, up to 64 in all. Raises the samples to a multiple of the groups.
//
// Two groups have little more noise than one sequence (1.4 times the variance of 64 samples of window, eight 2.4
// times); eight tell noise well where few pixels have most of it, which a target needs.
inline constexpr int usual_groups = 2, groups_for_target = 8, max_groups = 64;
int leaves_for(int groups, double samples);
Grouping grouping_of(int& samples, int groups = usual_groups);

// Names this program: plans are only rendered by the build that made them.
std::string build_name();

// Throws Error (unwritable).
void save_plan(const std::filesystem::path& file, const Scene& scene, const SavedPlan& plan);

// Throws Error (unreadable, refused): not a plan, or one of another version or build.
SavedPlan load_plan(const std::filesystem::path& file);

// Throws Error (refused) where the scene's files are not those that were planned for.
void check_inputs(const SavedPlan& plan, const Scene& scene);
}

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

// So many groups for so many samples a pixel, fewer where those are fewer; as many leaves, a power of two, as a
// section has samples, up to 64 in all. Raises the samples to what groups, and the sections of a single one, divide.
//
// One group has the noise of one sequence, and sections of it say that it is larger (1.9 times in window at 64
// samples). Independent groups tell it as it is, which a target needs, but have more: two 1.4 times the variance of
// one, eight 2.4 times.
inline constexpr int usual_groups = 1, groups_for_target = 8, max_groups = 64;
int leaves_for(int sections, double samples);
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

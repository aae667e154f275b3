// A plan as a file: everything that determines the bits of frames, for any number of machines.
#pragma once
#include "render/sequence/job.h"

#include <filesystem>
#include <string>

namespace tyndall {
struct Scene;

struct SavedPlan {
    RenderRequest request; // without output; frames and grouping are the plan's
    RenderPlan plan;
    std::vector<std::string> inputs; // content hashes of the scene's own files
    std::string build;               // of the program that made it
};

// Divides `samples` per pixel into groups, no more than there are samples; each section gets as many leaves, a power of
// two, as it has samples, up to 64 in all. Rounds `samples` up to a multiple of the groups, and of the sections if
// there is a single group.
//
// A single group has the noise of one sequence, which its sections overestimate (1.9 times in window at 64 samples).
// Independent groups show their noise correctly, as a target requires, but have more: two 1.4 times the variance of
// one, eight 2.4 times.
inline constexpr int default_groups = 1, groups_for_target = 8, max_groups = 64;
int leaves_for(int sections, double samples);
Grouping grouping_of(int& samples, int groups = default_groups);

// Identifies this build: plans are only rendered by the build that made them.
std::string build_name();

// Throws Error (unwritable).
void save_plan(const std::filesystem::path& file, const Scene& scene, const SavedPlan& plan);

// Throws Error (unreadable, refused): not a plan, or one of another version or build.
SavedPlan load_plan(const std::filesystem::path& file);

// Throws Error (refused) if the scene's files have changed since the plan was made.
void check_inputs(const SavedPlan& plan, const Scene& scene);
}

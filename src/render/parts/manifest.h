// What was prepared for a plan: a folder beside it, plan.json -> plan.cache, that holds cache files and for each frame
// a manifest, frame.0001.json, of the files it needs and of the volumes it was made from.
#pragma once
#include "base/io/cache_folder.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct SavedPlan;

struct FrameManifest {
    int frame = 0;
    std::string plan;                                    // hash
    std::map<std::filesystem::path, StampedHash> inputs; // volumes; absolute here, relative to the plan in the file
    std::map<std::string, CacheEntry> files;
};

std::filesystem::path cache_folder_of(const std::filesystem::path& plan_file);

// Throws Error (unwritable).
void save_manifest(const std::filesystem::path& plan_file, const FrameManifest& manifest);

// Nothing where the frame was not prepared. Throws Error (unreadable, refused).
std::optional<FrameManifest> load_manifest(const std::filesystem::path& plan_file, int frame);

// The files that were prepared for frames of a plan, copied to `local` unless that is empty; null where there are none.
// A note says so where they are of another plan. Throws Error (unreadable, refused).
std::shared_ptr<CacheFolder> open_prepared(const SavedPlan& plan, const std::vector<int>& frames,
                                           const std::filesystem::path& local, std::vector<std::string>& notes);

// Reads every byte of what was prepared for a frame of the plan, and of the volumes it was made from. Throws Error
// (unreadable, refused).
void check_prepared(const SavedPlan& plan, int frame);
}

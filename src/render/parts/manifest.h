// Prepared data of a plan: a folder next to it, plan.json -> plan.cache, that holds cache files and for each frame a
// manifest, frame.0001.json, of the files it needs and the volumes they were made from.
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

// None if the frame was not prepared. Throws Error (unreadable, refused).
std::optional<FrameManifest> load_manifest(const std::filesystem::path& plan_file, int frame);

// Opens the files prepared for frames of a plan, copied to `local` unless that is empty; null if there are none or,
// with a note, if they were prepared for another plan. Throws Error (unreadable, refused).
std::shared_ptr<CacheFolder> open_prepared(const SavedPlan& plan, const std::vector<int>& frames,
                                           const std::filesystem::path& local, std::vector<std::string>& notes);

// Reads and checks every byte of the files prepared for a frame of the plan. Throws Error (unreadable, refused).
void check_prepared(const SavedPlan& plan, int frame);
}

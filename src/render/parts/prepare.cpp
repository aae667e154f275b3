#include "render/parts/prepare.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "render/parts/plan_file.h"
#include "render/sequence/provenance.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>
#include <set>
#include <utility>

namespace tyndall {
namespace {
namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code none;
    for (fs::directory_iterator entry(folder, none); !none && entry != fs::directory_iterator(); entry.increment(none))
        if (entry->is_regular_file(none)) files.push_back(entry->path());
    std::ranges::sort(files);
    return files;
}

bool is_cache_file(const fs::path& file) { return file.extension() == cache_extension; }

// frame.0001.json
bool is_manifest(const fs::path& file, int& frame) {
    const std::string name = file.filename().string();
    if (!name.starts_with("frame.") || !name.ends_with(".json")) return false;
    const std::optional<int> number = parsed<int>(std::string_view(name).substr(6, name.size() - 11));
    frame = number.value_or(0);
    return number.has_value();
}

uint64_t remove_file(const fs::path& file) {
    std::error_code error;
    const uint64_t size = fs::file_size(file, error);
    fs::remove(file, error);
    if (error) fail(ExitCode::unwritable, file.string(), "cannot be removed: " + error.message());
    return size;
}

FrameManifest manifest_of(const SavedPlan& plan, int frame, const CacheFolder& folder) {
    FrameManifest manifest{frame, plan.request.grouping.plan_hash, {}, {}};
    for (const auto& [path, input] : folder.inputs->known) manifest.inputs[normal_path(path)] = input;
    for (const CacheCost& cost : folder.costs) // current stamps: another run may have rewritten a file
        if (!cost.file.empty())
            manifest.files[cost.file] = {stamp_of(folder.folder / cost.file), folder.files.at(cost.file).hash};
    return manifest;
}
}

std::shared_ptr<CacheFolder> open_to_prepare(const SavedPlan& plan, uint64_t most) {
    const Grouping& grouping = plan.request.grouping;
    auto folder = std::make_shared<CacheFolder>(cache_folder_of(grouping.plan_file));
    folder->build = plan.build + " " + plan.request.isa, folder->plan = grouping.plan_hash;
    folder->writes = true, folder->room = most;
    check_output(folder->folder / "frame.json");
    sweep_temporaries(folder->folder);
    for (const fs::path& file : files_in(folder->folder)) {
        if (!is_cache_file(file)) continue;
        const FileStamp stamp = stamp_of(file);
        folder->files[file.filename().string()] = {stamp, {}};
        folder->room -= std::min(folder->room, stamp.size);
    }
    return folder;
}

std::vector<CacheCost> prepare_for_parts(const Scene& scene, const SavedPlan& plan, int frame,
                                         const std::shared_ptr<CacheFolder>& folder) {
    const RenderRequest& request = plan.request;
    folder->costs.clear();
    FileHashes& inputs = *folder->inputs;
    for (auto& [path, input] : inputs.known) inputs.recorded[normal_path(path)] = std::move(input);
    inputs.known.clear(), inputs.recorded_in = folder->folder;
    const double start = steady_seconds();
    hash_fog(scene, request, frame, inputs);
    if (!inputs.known.empty()) record_cost(folder.get(), "hashing volumes", steady_seconds() - start, CostKind::cached);

    // Shares nothing with other frames: data in common is looked up in the folder, and so listed in every manifest.
    const Snapshot snapshot = make_snapshot(scene, moments_of(scene, request, frame), nullptr, request.missing, folder);
    prepare_files(*plan.plan.mode, view_of(scene, request, plan.plan.settings, frame), snapshot, plan.plan.settings);
    check_unchanged(*folder);
    save_manifest(request.grouping.plan_file, manifest_of(plan, frame, *folder));
    return std::exchange(folder->costs, {});
}

uint64_t clean_prepared(const SavedPlan& plan, bool all) {
    const Grouping& grouping = plan.request.grouping;
    const fs::path folder = cache_folder_of(grouping.plan_file);
    std::set<std::string> needed;
    std::vector<fs::path> unneeded;
    for (const fs::path& file : files_in(folder)) {
        int frame = 0;
        if (!is_manifest(file, frame)) continue;
        const bool planned = !all && std::ranges::count(plan.request.frames, frame) > 0;
        const std::optional<FrameManifest> manifest = planned ? load_manifest(grouping.plan_file, frame) : std::nullopt;
        if (!manifest || manifest->plan != grouping.plan_hash)
            unneeded.push_back(file);
        else
            for (const auto& [name, entry] : manifest->files) needed.insert(name);
    }
    for (const fs::path& file : files_in(folder))
        if (is_cache_file(file) && !needed.contains(file.filename().string())) unneeded.push_back(file);
    uint64_t bytes = 0;
    for (const fs::path& file : unneeded) bytes += remove_file(file); // manifests before the files they name
    sweep_temporaries(folder);
    std::error_code not_empty;
    if (all) fs::remove(folder, not_empty);
    return bytes;
}
}

#include "render/parts/manifest.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/json/json_values.h"
#include "base/text.h"
#include "cache_manifest_schema.h"
#include "render/parts/plan_file.h"

namespace tyndall {
namespace {
namespace fs = std::filesystem;

fs::path manifest_file(const fs::path& plan_file, int frame) {
    return cache_folder_of(plan_file) / formatted("frame.%04d.json", frame);
}

fs::path plan_folder(const fs::path& plan_file) { return normal_path(plan_file).parent_path(); }

Json file_json(const std::string& name, const FileStamp& stamp, const std::string& hash) {
    return json_object({{"name", name},
                        {"bytes", static_cast<double>(stamp.size)},
                        {"changed", std::to_string(stamp.changed)}, // as text: JSON numbers would lose the last digits
                        {"hash", hash}});
}

FileStamp stamp_in(const Json& file) {
    return {static_cast<uint64_t>(file.number_or("bytes", 0)),
            parsed<int64_t>(file.string_or("changed", "")).value_or(0)};
}

// The name of a cache file in the folder itself; refuses any other path.
std::string plain_name(const Json& file, const fs::path& manifest) {
    std::string name = file.string_or("name", "");
    if (fs::path(name).filename() != name || !name.ends_with(cache_extension))
        refuse(manifest.string() + ": /files", "expected names of files in its folder; got " + printable(name, 80));
    return name;
}
}

fs::path cache_folder_of(const fs::path& plan_file) { return fs::path(plan_file).replace_extension(cache_extension); }

void save_manifest(const fs::path& plan_file, const FrameManifest& manifest) {
    std::vector<Json> inputs, files;
    for (const auto& [path, input] : manifest.inputs)
        inputs.push_back(file_json(path.lexically_relative(plan_folder(plan_file)).string(), input.stamp, input.hash));
    for (const auto& [name, file] : manifest.files) files.push_back(file_json(name, file.stamp, file.hash));
    write_file_atomically(manifest_file(plan_file, manifest.frame), json_line({{"tyndall_cache", 1},
                                                                               {"plan", manifest.plan},
                                                                               {"frame", manifest.frame},
                                                                               {"inputs", inputs},
                                                                               {"files", files}}));
}

std::optional<FrameManifest> load_manifest(const fs::path& plan_file, int frame) {
    const fs::path file = manifest_file(plan_file, frame);
    std::error_code none;
    if (!fs::exists(file, none)) return {};
    const Json json = read_json(file, cache_manifest_schema);
    FrameManifest manifest{frame, json.string_or("plan", ""), {}, {}};
    for (const Json& input : json.find("inputs")->items)
        manifest.inputs[(plan_folder(plan_file) / input.string_or("name", "")).lexically_normal()] = {
            stamp_in(input), input.string_or("hash", "")};
    for (const Json& entry : json.find("files")->items)
        manifest.files[plain_name(entry, file)] = {stamp_in(entry), entry.string_or("hash", "")};
    return manifest;
}

std::shared_ptr<CacheFolder> open_prepared(const SavedPlan& plan, const std::vector<int>& frames, const fs::path& local,
                                           std::vector<std::string>& notes) {
    const Grouping& grouping = plan.request.grouping;
    std::shared_ptr<CacheFolder> folder;
    for (const int frame : frames) {
        std::optional<FrameManifest> manifest = load_manifest(grouping.plan_file, frame);
        if (!manifest) continue;
        const fs::path path = cache_folder_of(grouping.plan_file);
        if (manifest->plan != grouping.plan_hash) {
            notes.push_back(path.string() + " was prepared for another plan: not used");
            return nullptr;
        }
        if (!folder) {
            folder = std::make_shared<CacheFolder>(path, local);
            folder->build = plan.build + " " + plan.request.isa, folder->plan = grouping.plan_hash;
            folder->inputs->recorded_in = manifest_file(grouping.plan_file, frame);
        }
        folder->files.merge(manifest->files), folder->inputs->recorded.merge(manifest->inputs);
    }
    return folder;
}

void check_prepared(const SavedPlan& plan, int frame) {
    std::vector<std::string> notes;
    const std::shared_ptr<CacheFolder> folder = open_prepared(plan, {frame}, {}, notes);
    if (!folder) return;
    for (const auto& [name, entry] : folder->files) check_cache_file(*folder, name, entry);
}
}

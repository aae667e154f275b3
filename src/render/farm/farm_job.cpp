#include "render/farm/farm_job.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/file_hashes.h"
#include "base/io/frames.h"
#include "base/json/json_values.h"
#include "job_schema.h"

#include <algorithm>

namespace tyndall {
std::filesystem::path job_folder(const std::filesystem::path& folder) {
    const std::filesystem::path path = normal_path(folder);
    return path.has_filename() ? path : path.parent_path();
}

std::string job_name_of(const std::filesystem::path& scene) {
    std::string name = scene.stem().string();
    for (char& c : name) {
        const bool plain =
            (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
        if (!plain) c = '_';
    }
    if (name.empty() || name[0] == '-') name.insert(0, 1, '_');
    return name.substr(0, 100);
}

std::string job_text(const FarmJob& job) {
    JsonMembers members{{"tyndall_job", 1},
                        {"version", TYNDALL_VERSION},
                        {"engine", job.engine},
                        {"program", job.program},
                        {"scene", job.scene},
                        {"name", job.name},
                        {"frames", format_frames(job.frames)},
                        {"parts", job.parts},
                        {"chunk", job.chunk},
                        {"plan_for_each_frame", job.plan_for_each_frame},
                        {"plan_options", job.plan_options},
                        {"remove_parts", job.remove_parts}};
    if (job.cpus > 0) members.emplace_back("cpus", job.cpus);
    if (job.memory > 0) members.emplace_back("memory", job.memory);
    if (job.minutes > 0) members.emplace_back("minutes", job.minutes);
    return json_line(std::move(members));
}

void save_job(const FarmJob& job) { write_file_atomically(job.folder / "job.json", job_text(job)); }

FarmJob load_job(const std::filesystem::path& folder) {
    const Json json = read_json(folder / "job.json", job_schema);
    FarmJob job;
    job.folder = job_folder(folder);
    job.engine = json.string_or("engine", "");
    job.program = json.string_or("program", "");
    job.scene = json.string_or("scene", "");
    job.name = json.string_or("name", "");
    try {
        job.frames = parse_frames(json.string_or("frames", ""));
    } catch (const Error& error) {
        refuse((folder / "job.json").string() + ": /frames", error.what());
    }
    std::ranges::sort(job.frames);
    job.parts = static_cast<int>(json.number_or("parts", 1));
    job.chunk = static_cast<int>(json.number_or("chunk", 1));
    job.cpus = static_cast<int>(json.number_or("cpus", 0));
    job.memory = static_cast<int>(json.number_or("memory", 0));
    job.minutes = static_cast<int>(json.number_or("minutes", 0));
    job.plan_for_each_frame = json.boolean_or("plan_for_each_frame", false);
    for (const Json& word : json.find("plan_options")->items) job.plan_options.push_back(word.string);
    job.remove_parts = json.boolean_or("remove_parts", false);
    return job;
}

std::string plan_name(const FarmJob& job, int frame) {
    return job.plan_for_each_frame ? "plans/plan." + std::to_string(frame) + ".json" : "plan.json";
}

std::string part_pattern(const FarmJob& job) { return "parts/" + job.name + ".####.exr"; }
std::string frame_pattern(const FarmJob& job) { return "frames/" + job.name + ".####.exr"; }

std::vector<std::vector<int>> chunks_of(const FarmJob& job) {
    std::vector<std::vector<int>> chunks;
    const size_t size = static_cast<size_t>(job.chunk);
    for (size_t i = 0; i < job.frames.size(); i += size) {
        const auto first = job.frames.begin() + static_cast<std::ptrdiff_t>(i);
        const auto count = static_cast<std::ptrdiff_t>(std::min(size, job.frames.size() - i));
        chunks.emplace_back(first, first + count);
    }
    return chunks;
}
}

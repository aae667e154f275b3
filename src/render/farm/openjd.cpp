#include "render/farm/openjd.h"

#include "base/error.h"
#include "base/io/frames.h"
#include "base/json/json_values.h"
#include "render/farm/commands.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int seconds_to_stop = 30; // after SIGTERM: a checkpoint is written within 25

// Formats objects and arrays of objects over several lines, everything else on one.
void append_lines(std::string& text, const Json& value, const std::string& indent) {
    const bool object = value.kind == Json::Kind::object;
    const auto holds_objects = [](const Json& item) { return item.kind == Json::Kind::object; };
    if (!object && !std::ranges::any_of(value.items, holds_objects) && value.items.size() < 20) {
        text += format_json(value);
        return;
    }
    const std::string deeper = indent + "  ";
    text += object ? "{" : "[";
    const char* between = "\n";
    for (const auto& [name, member] : value.members) {
        text += between + deeper + quote_json(name) + ": ";
        append_lines(text, member, deeper);
        between = ",\n";
    }
    for (const Json& item : value.items) {
        text += between + deeper;
        append_lines(text, item, deeper);
        between = ",\n";
    }
    text += "\n" + indent + (object ? "}" : "]");
}

std::string in_lines(JsonMembers members) {
    std::string text;
    append_lines(text, json_object(std::move(members)), "");
    return text + "\n";
}

// Ranges in OpenJD's syntax: 1-9:2.
std::string frames_text(const FarmJob& job) {
    std::string text = format_frames(job.frames);
    std::ranges::replace(text, 'x', ':');
    return text;
}

// The default of a PATH has to be relative to the template, so the program, which is elsewhere, is a STRING.
Json parameters(const FarmJob& job) {
    return std::vector{json_object({{"name", "Tyndall"},
                                    {"type", "STRING"},
                                    {"default", job.program},
                                    {"description", "Path of tyndall on the workers: the build that made the plan."}}),
                       json_object({{"name", "Folder"},
                                    {"type", "PATH"},
                                    {"objectType", "DIRECTORY"},
                                    {"dataFlow", "INOUT"},
                                    {"default", "."},
                                    {"description", "The job's folder: plan, parts, frames."}}),
                       json_object({{"name", "Frames"},
                                    {"type", "STRING"},
                                    {"default", frames_text(job)},
                                    {"description", "Which frames: 1-10:2 or 1,5,9."}})};
}

// Frames that share a plan come in chunks, whose size the engine may change.
Json frames_parameter(const FarmJob& job) {
    JsonMembers members{{"name", "Frames"}, {"range", "{{Param.Frames}}"}};
    if (job.plan_for_each_frame) {
        members.emplace_back("type", "INT");
    } else {
        members.emplace_back("type", "CHUNK[INT]");
        members.emplace_back("chunks",
                             json_object({{"defaultTaskCount", job.chunk}, {"rangeConstraint", "NONCONTIGUOUS"}}));
    }
    return json_object(std::move(members));
}

Json requirements(const FarmJob& job, const TaskLimits& limits) {
    JsonMembers members{
        {"attributes",
         std::vector{json_object({{"name", "attr.worker.os.family"}, {"anyOf", std::vector<Json>{"linux"}}}),
                     json_object({{"name", "attr.worker.cpu.arch"}, {"anyOf", std::vector<Json>{"x86_64"}}})}}};
    std::vector<Json> amounts;
    if (job.cpus > 0) amounts.push_back(json_object({{"name", "amount.worker.vcpu"}, {"min", job.cpus}}));
    if (limits.memory > 0) amounts.push_back(json_object({{"name", "amount.worker.memory"}, {"min", limits.memory}}));
    if (!amounts.empty()) members.emplace_back("amounts", amounts);
    return json_object(std::move(members));
}

Json step(const FarmJob& job, const TaskLimits& limits, const char* name, const char* after,
          std::vector<Json> parameters_of_task, CommandArgs words) {
    words.insert(words.end(), {"--progress", "openjd"});
    if (job.cpus > 0) words.insert(words.end(), {"--threads", std::to_string(job.cpus)});
    const Json cancelation =
        json_object({{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", seconds_to_stop}});
    const Json run = json_object({{"command", "{{Param.Tyndall}}"}, {"args", words}, {"cancelation", cancelation}});
    JsonMembers members{{"name", name}};
    if (after) members.emplace_back("dependencies", std::vector{json_object({{"dependsOn", after}})});
    members.emplace_back("hostRequirements", requirements(job, limits));
    members.emplace_back("parameterSpace", json_object({{"taskParameterDefinitions", std::move(parameters_of_task)}}));
    members.emplace_back("script", json_object({{"actions", json_object({{"onRun", run}})}}));
    return json_object(std::move(members));
}

// The scene's path relative to the job's folder, so that it is found on another machine too.
std::string scene_name(const FarmJob& job) {
    return "{{Param.Folder}}/" + std::filesystem::path(job.scene).lexically_relative(job.folder).string();
}

void check_words(const FarmJob& job) {
    std::vector<std::string> words = job.plan_options;
    words.push_back(job.scene);
    for (const std::string& word : words)
        if (word.find("{{") != word.npos)
            fail(ExitCode::usage, "openjd",
                 "'" + printable(word, 60) + "': must not contain {{, which OpenJD cannot escape");
}
}

std::string openjd_template(const FarmJob& job, const TaskLimits& limits) {
    check_words(job);
    const CommandVars vars{"{{Param.Folder}}/", scene_name(job), "{{Task.Param.Frames}}", "{{Task.Param.Part}}"};
    const Json frames = frames_parameter(job);
    const Json part = json_object({{"name", "Part"}, {"type", "INT"}, {"range", "1-" + std::to_string(job.parts)}});
    std::vector<Json> steps;
    if (job.plan_for_each_frame) steps.push_back(step(job, limits, "Plan", nullptr, {frames}, plan_args(job, vars)));
    const char* before = job.plan_for_each_frame ? "Plan" : nullptr;
    if (shares_work(job)) {
        steps.push_back(step(job, limits, "Prepare", before, {frames}, prepare_args(job, vars)));
        before = "Prepare";
    }
    steps.push_back(step(job, limits, "Parts", before, {frames, part}, render_args(job, vars)));
    steps.push_back(step(job, limits, "Merge", "Parts", {frames}, merge_args(job, vars)));

    JsonMembers members{{"specificationVersion", "jobtemplate-2023-09"}};
    if (!job.plan_for_each_frame) members.emplace_back("extensions", std::vector<Json>{"TASK_CHUNKING"});
    members.emplace_back("name", job.name);
    members.emplace_back("parameterDefinitions", parameters(job));
    members.emplace_back("steps", std::move(steps));
    return in_lines(std::move(members));
}

std::string openjd_asset_references(const FarmJob& job, const std::vector<std::filesystem::path>& inputs) {
    const Json files = json_list(inputs, [](const std::filesystem::path& file) { return Json(file.string()); });
    const std::vector<Json> none;
    const Json read = json_object({{"filenames", files}, {"directories", none}});
    const Json written = json_object({{"directories", std::vector<Json>{job.folder.string()}}});
    return in_lines(
        {{"assetReferences", json_object({{"inputs", read}, {"outputs", written}, {"referencedPaths", none}})}});
}
}

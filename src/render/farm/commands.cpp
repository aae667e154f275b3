#include "render/farm/commands.h"

namespace tyndall {
namespace {
std::string plan_file(const FarmJob& job, const CommandVars& vars) {
    return vars.folder + (job.plan_for_each_frame ? "plans/plan." + vars.frames + ".json" : "plan.json");
}
}

CommandArgs plan_args(const FarmJob& job, const CommandVars& vars) {
    CommandArgs words{"plan", vars.scene};
    words.insert(words.end(), job.plan_options.begin(), job.plan_options.end());
    words.insert(words.end(), {"--frames", vars.frames, "--save", plan_file(job, vars)});
    return words;
}

CommandArgs prepare_args(const FarmJob& job, const CommandVars& vars) {
    return {"prepare", "--plan", plan_file(job, vars), "--frames", vars.frames};
}

CommandArgs render_args(const FarmJob& job, const CommandVars& vars) {
    return {"render",
            "--plan",
            plan_file(job, vars),
            "-o",
            vars.folder + part_pattern(job),
            "--frames",
            vars.frames,
            "--part",
            vars.part + "/" + std::to_string(job.parts),
            "--resume"};
}

CommandArgs merge_args(const FarmJob& job, const CommandVars& vars) {
    CommandArgs words{
        "merge", vars.folder + part_pattern(job), "--parts", std::to_string(job.parts), "--frames", vars.frames,
        "-o",    vars.folder + frame_pattern(job)};
    words.insert(words.end(), {"--wait", "30"}); // shared file systems show new files late
    if (job.remove_parts) words.emplace_back("--remove-parts");
    return words;
}
}

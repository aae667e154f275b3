#include "render/farm/commands.h"

namespace tyndall {
namespace {
std::string plan_file(const FarmJob& job, const CommandBlanks& blanks) {
    return blanks.folder + (job.plan_for_each_frame ? "plans/plan." + blanks.frames + ".json" : "plan.json");
}
}

CommandWords plan_words(const FarmJob& job, const CommandBlanks& blanks) {
    CommandWords words{"plan", blanks.scene};
    words.insert(words.end(), job.plan_options.begin(), job.plan_options.end());
    words.insert(words.end(), {"--frames", blanks.frames, "--save", plan_file(job, blanks)});
    return words;
}

CommandWords prepare_words(const FarmJob& job, const CommandBlanks& blanks) {
    return {"prepare", "--plan", plan_file(job, blanks), "--frames", blanks.frames};
}

CommandWords render_words(const FarmJob& job, const CommandBlanks& blanks) {
    return {"render",
            "--plan",
            plan_file(job, blanks),
            "-o",
            blanks.folder + part_pattern(job),
            "--frames",
            blanks.frames,
            "--part",
            blanks.part + "/" + std::to_string(job.parts),
            "--resume"};
}

CommandWords merge_words(const FarmJob& job, const CommandBlanks& blanks) {
    CommandWords words{
        "merge", blanks.folder + part_pattern(job), "--parts", std::to_string(job.parts), "--frames", blanks.frames,
        "-o",    blanks.folder + frame_pattern(job)};
    words.insert(words.end(), {"--wait", "30"}); // shared file systems show new files late
    if (job.remove_parts) words.emplace_back("--remove-parts");
    return words;
}
}

#include "render/farm/slurm.h"

#include "base/io/frames.h"
#include "base/text.h"
#include "render/farm/commands.h"
#include "slurm_submit_text.h"
#include "slurm_task_text.h"

namespace tyndall {
namespace {
// Placeholders in command words for shell variables of task.sh.
constexpr std::string_view frames_blank = "\1frames", part_blank = "\1part";

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size()) text.replace(at, what.size(), by);
    return text;
}

// Fills in the @BLANKS@ of a script in a single pass, since what fills one may look like another.
using Fillings = std::vector<std::pair<std::string, std::string>>;
std::string filled(std::string_view script, const Fillings& fillings) {
    std::string text;
    while (!script.empty()) {
        const auto* next = static_cast<const Fillings::value_type*>(nullptr);
        for (const auto& filling : fillings)
            if (script.starts_with(filling.first)) next = &filling;
        text += next ? next->second : std::string(1, script[0]);
        script.remove_prefix(next ? next->first.size() : 1);
    }
    return text;
}

std::string shell_line(const CommandArgs& words) {
    std::string line;
    for (const std::string& word : words) {
        line += line.empty() ? "" : " ";
        if (word.find('\1') == word.npos)
            line += quoted_for_shell(word);
        else
            line += '"' + replaced(replaced(word, frames_blank, "${frames}"), part_blank, "${part}") + '"';
    }
    return line;
}

// The frames of each chunk, one word per chunk, wrapped into lines.
std::string chunk_table(const FarmJob& job) {
    std::vector<std::string> words;
    for (const std::vector<int>& chunk : chunks_of(job)) words.push_back(format_frames(chunk));
    return wrapped(joined(words, " "), 110, 2);
}
}

std::string slurm_task_script(const FarmJob& job) {
    const CommandVars vars{"", job.scene, std::string(frames_blank), std::string(part_blank)};
    const std::string plan = job.plan_for_each_frame ? "plan)\n  frames=${chunks[number]}\n  run " +
                                                           shell_line(plan_args(job, vars)) + " ;;\n"
                                                     : std::string();
    const std::string prepare = shares_work(job) ? "prepare)\n  frames=${chunks[number]}\n  run " +
                                                       shell_line(prepare_args(job, vars)) + " ;;\n"
                                                 : std::string();
    return filled(slurm_task_text, {{"@PROGRAM@", quoted_for_shell(job.program)},
                                    {"@CHUNKS@", chunk_table(job)},
                                    {"@PARTS@", std::to_string(job.parts)},
                                    {"@PLAN@\n", plan + prepare},
                                    {"@RENDER@", shell_line(render_args(job, vars))},
                                    {"@MERGE@", shell_line(merge_args(job, vars))}});
}

namespace {
std::string usual(const char* variable, int value) {
    return formatted("export %s=\"${%s:-%d}\"\n", variable, variable, value);
}
}

std::string slurm_submit_script(const FarmJob& job, const TaskLimits& limits) {
    std::string options = "--parsable --requeue --open-mode=append --signal=B:TERM@60";
    if (job.cpus > 0) options += formatted(" --cpus-per-task=%d", job.cpus);
    if (job.memory > 0) options += formatted(" --mem=%d", job.memory);
    if (job.minutes > 0) options += formatted(" --time=%d", job.minutes);
    std::string forecast; // for what neither the job nor the environment sets
    if (job.memory == 0 && limits.memory > 0)
        forecast += "[ -n \"${SBATCH_MEM_PER_CPU:-}\" ] || " + usual("SBATCH_MEM_PER_NODE", limits.memory);
    if (job.minutes == 0 && limits.minutes > 0) forecast += usual("SBATCH_TIMELIMIT", limits.minutes);
    return filled(slurm_submit_text, {{"@PROGRAM@", quoted_for_shell(job.program)},
                                      {"@OPTIONS@", options},
                                      {"@LIMITS@\n", forecast},
                                      {"@STEPS@", std::string(job.plan_for_each_frame ? "plan " : "") +
                                                      (shares_work(job) ? "prepare " : "") + "parts merge"},
                                      {"@NAME@", job.name}});
}

std::vector<std::string> slurm_arrays(const std::vector<int>& tasks) {
    std::vector<std::string> arrays;
    for (size_t i = 0; i < tasks.size();) {
        const int first = tasks[i] / tasks_of_array * tasks_of_array;
        std::vector<int> within;
        for (; i < tasks.size() && tasks[i] < first + tasks_of_array; ++i) within.push_back(tasks[i] - first);
        arrays.push_back(std::to_string(first) + " " + replaced(format_frames(within), "x", ":"));
    }
    return arrays;
}
}

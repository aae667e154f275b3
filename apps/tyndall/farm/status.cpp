// tyndall status: what is finished, missing or suspicious in a farm job, and the commands that render what is missing.
#include "common.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "render/farm/farm_status.h"
#include "render/farm/slurm.h"

namespace tyndall {
namespace {
constexpr size_t shown = 20; // lines per list; --json has all

struct Options {
    std::string folder, tasks;
    bool verify = false;
};

struct Counts {
    uint64_t missing_parts = 0;
    std::vector<int> unfinished; // frames
};

Counts counted(const FarmStatus& status) {
    Counts counts;
    for (const FarmFrame& frame : status.frames) {
        counts.missing_parts += frame.missing.size();
        if (!frame.finished) counts.unfinished.push_back(frame.frame);
    }
    return counts;
}

std::string status_json(const FarmJob& job, const FarmStatus& status, const Counts& counts,
                        const std::vector<std::string>& commands, double seconds) {
    std::vector<Json> unfinished;
    for (const FarmFrame& frame : status.frames)
        if (!frame.finished)
            unfinished.push_back(
                json_object({{"frame", frame.frame}, {"planned", frame.planned}, {"missing_parts", frame.missing}}));
    const auto suspect = [](const SuspectFile& file) { return json_object({{"file", file.file}, {"why", file.why}}); };
    return json_line({{"folder", job.folder.string()},
                      {"engine", job.engine},
                      {"frames", job.frames.size()},
                      {"parts", job.parts},
                      {"finished", job.frames.size() - counts.unfinished.size()},
                      {"missing_parts", static_cast<double>(counts.missing_parts)},
                      {"unfinished", unfinished},
                      {"suspicious", json_list(status.suspects, suspect)},
                      {"temporaries", static_cast<double>(status.temporaries)},
                      {"checkpoints", static_cast<double>(status.checkpoints)},
                      {"commands", commands},
                      {"seconds", seconds}});
}

template<class Values, class Text> std::string some_lines(const Values& values, const Text& text) {
    std::string lines;
    for (size_t i = 0; i < values.size() && i < shown; ++i) lines += "  " + text(values[i]) + "\n";
    if (values.size() > shown) lines += formatted("  and %zu more (--json lists all)\n", values.size() - shown);
    return lines;
}

std::string status_text(const FarmJob& job, const FarmStatus& status, const Counts& counts,
                        const std::vector<std::string>& commands) {
    const size_t finished = job.frames.size() - counts.unfinished.size();
    std::string text = printable(job.folder.string(), 300) + ": " + count_text(job.frames.size(), "frame") + " in " +
                       count_text(static_cast<uint64_t>(job.parts), "part") + ", " + job.engine + "\n" +
                       formatted("finished: %zu of %zu frames\n", finished, job.frames.size());
    if (!counts.unfinished.empty())
        text += "missing: frames " + printable(format_frames(counts.unfinished), 300) + ", of which " +
                count_text(counts.missing_parts, "part") + " are not rendered\n";
    if (status.checkpoints > 0)
        text += "started: " + count_text(status.checkpoints, "part") + ", according to checkpoints\n";
    if (status.temporaries > 0)
        text += "temporary: " + count_text(status.temporaries, "file") + ", being written or left by killed tasks\n";
    if (!status.suspects.empty())
        text += "suspicious:\n" + some_lines(status.suspects, [](const SuspectFile& file) {
                    return printable(file.file, 200) + ": " + printable(file.why, 200);
                });
    if (!commands.empty() && job.engine == "slurm")
        text += "to submit what is missing:\n  bash " + quoted_for_shell((job.folder / "submit.sh").string()) + "\n";
    if (!commands.empty())
        text += "to render what is missing on this machine:\n" +
                some_lines(commands, [](const std::string& command) { return printable(command, 2000); });
    return text;
}

int run_status(const Options& args, const Globals& globals) {
    const double start = steady_seconds();
    const FarmJob job = load_job(args.folder);
    const FarmStatus status = job_status(job, args.verify, cancel_flag());
    stop_if_cancelled();
    if (!args.tasks.empty()) {
        choice_among("--tasks", args.tasks, {"plan", "prepare", "parts", "merge"});
        print_report(joined(slurm_arrays(missing_tasks(job, status, args.tasks)), "\n"));
        return 0;
    }
    const Counts counts = counted(status);
    const std::vector<std::string> commands = missing_commands(job, status);
    if (globals.json)
        print_report(status_json(job, status, counts, commands, steady_seconds() - start));
    else
        print_report(status_text(job, status, counts, commands));
    return counts.unfinished.empty() ? 0 : static_cast<int>(ExitCode::differs);
}
}

Run add_status(const Command& program) {
    const Command command = program.command("status", "what a farm job has finished, and how to render the rest");
    auto args = std::make_shared<Options>();
    command.option("FOLDER", args->folder, "folder that tyndall submit wrote", "").required();
    command.flag("--verify", args->verify, "read every byte of every file (default: names, sizes and headers)");
    command.option("--tasks", args->tasks,
                   "print only the unfinished task numbers of a step, as arrays for submit.sh:\n"
                   "plan, prepare, parts or merge",
                   "STEP");
    command.footer("Example: tyndall status out/window\n"
                   "Frames whose parts were removed count as finished. Exit code 0: all frames are finished; 1: some\n"
                   "are not, and the commands that render them are printed.");
    return [args](const Globals& globals) { return run_status(*args, globals); };
}
}

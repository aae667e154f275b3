// tyndall submit: writes a job for a render farm, in the files of its engine.
#include "base/io/file_hashes.h"
#include "rendering/automatic.h"
#include "rendering/plan_as_asked.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "modes/mode.h"
#include "render/farm/farm_status.h"
#include "render/farm/forecast.h"
#include "render/farm/inputs.h"
#include "render/farm/openjd.h"
#include "render/farm/slurm.h"
#include "render/parts/part_file.h"
#include "render/parts/plan_file.h"
#include "scene/input_files.h"
#include "scene/scene.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tyndall {
namespace {
struct Options {
    RenderOptions render; // those that a plan takes; files go to `folder`, not to render.output
    std::string engine, groups, parts, chunk, cpus, memory, minutes, folder;
    bool dry_run = false, run = false, remove_parts = false;
};

int number_or(const char* name, const std::string& text, int otherwise, int high) {
    return text.empty() ? otherwise : static_cast<int>(integer_option(name, text, 1, high));
}

FarmJob job_of(const Options& args, const Scene& scene) {
    std::error_code ignored;
    FarmJob job;
    job.folder = job_folder(args.folder);
    job.engine = args.engine;
    job.program = std::filesystem::read_symlink("/proc/self/exe", ignored).string();
    job.scene = normal_path(args.render.scene).string();
    job.name = job_name_of(job.scene);
    job.frames = args.render.frames.empty() ? frames_between(scene.first_frame, scene.last_frame)
                                            : parse_frames(args.render.frames);
    std::ranges::sort(job.frames);
    job.parts = number_or("--parts", args.parts, 1, 1 << 16);
    job.chunk = number_or("--chunk", args.chunk, 1, 1000000);
    job.cpus = number_or("--cpus", args.cpus, 0, 1024);
    job.memory = number_or("--memory", args.memory, 0, 1 << 30);
    job.minutes = number_or("--minutes", args.minutes, 0, 1 << 24);
    job.plan_for_each_frame = args.render.mode == automatic || !args.render.target_error.empty();
    job.plan_options = planned_words(args.render);
    if (!args.groups.empty()) job.plan_options.insert(job.plan_options.end(), {"--groups", args.groups});
    job.remove_parts = args.remove_parts;
    if (job.plan_for_each_frame && job.chunk > 1)
        fail(ExitCode::usage, "--chunk", "with --target-error or --mode auto, each frame has its own plan and task");
    return job;
}

// Name and text of the files in the folder besides job.json and the plan, in the order they are written.
using FarmFiles = std::vector<std::pair<std::string, std::string>>;
FarmFiles files_of(const FarmJob& job, const Scene& scene, const RenderRequest& request, const TaskLimits& limits) {
    if (job.engine == "slurm")
        return {{"task.sh", slurm_task_script(job)}, {"submit.sh", slurm_submit_script(job, limits)}};
    return {{"asset_references.yaml", openjd_asset_references(job, input_files(scene, job.frames, request))},
            {"template.json", openjd_template(job, limits)}};
}

std::vector<std::string> run_words(const FarmJob& job) {
    if (job.engine == "slurm") return {"bash", (job.folder / "submit.sh").string()};
    return {"openjd", "run", (job.folder / "template.json").string(), "--step", "Merge", "--run-dependencies"};
}

std::string shell_text(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted_for_shell(word);
    return text;
}

// Runs the engine's own program, with our standard streams, and waits for it.
void run(std::vector<std::string> words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    pid_t child = 0;
    if (const int error = posix_spawnp(&child, pointers[0], nullptr, nullptr, pointers.data(), environ))
        fail(ExitCode::unreadable, words[0], std::strerror(error));
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) fail(ExitCode::internal, words[0], std::strerror(errno));
    if (status != 0)
        fail(ExitCode::differs, words[0],
             WIFEXITED(status) ? formatted("ended with exit code %d; the job's files are written", WEXITSTATUS(status))
                               : formatted("was killed by signal %d; the job's files are written", WTERMSIG(status)));
}

// The same job may be written again. Throws Error when the folder holds another job.
void check_folder(const FarmJob& job) {
    const std::filesystem::path file = job.folder / "job.json";
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored) && read_file(file) != job_text(job))
        fail(ExitCode::usage, "--output",
             printable(job.folder.string(), 200) + " contains another job: use another folder");
}

// Checks that the saved plan can be split into this many parts before the job is handed over; removes it if not.
void check_parts_of(const FarmJob& job, const Scene& scene) {
    SavedPlan plan = load_plan(job.folder / "plan.json");
    plan.request.grouping.parts = plan.request.grouping.part = job.parts;
    try {
        range_of(plan.request.grouping, *plan.plan.mode,
                 view_of(scene, plan.request, plan.plan.settings, plan.request.frames[0]));
    } catch (const Error& error) {
        std::filesystem::remove(job.folder / "plan.json");
        fail(error.code, "--parts", error.what());
    }
}

void write_job(const FarmJob& job, const FarmFiles& files, const Options& args, const Scene& scene,
               const Globals& globals) {
    OutputPaths places;
    for (const char* name : {"job.json", "plan.json"}) places.check(job.folder / name);
    spare_files(scene, places);
    if (!job.plan_for_each_frame) {
        Globals quiet = globals;
        quiet.quiet = true;
        RenderOptions render = args.render;
        render.frames = format_frames(job.frames);
        save_plan_as_asked(render, args.groups, (job.folder / "plan.json").string(), quiet);
        check_parts_of(job, scene);
    }
    for (const char* name : {"parts", "frames", "logs", "plans"})
        if (job.plan_for_each_frame || std::string_view(name) != "plans") check_output(job.folder / name / job.name);
    for (const auto& [name, text] : files) write_file_atomically(job.folder / name, text);
    save_job(job);
}

// The Slurm task arrays of a job with nothing rendered yet; empty for other engines.
std::string arrays_of_new(const FarmJob& job, const std::string& step) {
    if (job.engine != "slurm") return {};
    FarmStatus nothing;
    for (const int frame : job.frames) {
        FarmFrame& missing = nothing.frames.emplace_back(FarmFrame{frame, !job.plan_for_each_frame, false, {}});
        for (int part = 1; part <= job.parts; ++part) missing.missing.push_back(part);
    }
    return joined(slurm_arrays(missing_tasks(job, nothing, step)), "\n");
}

void say_dry(const FarmJob& job, const FarmFiles& files) {
    std::string report;
    const auto add = [&](const std::string& name, const std::string& text) {
        report += "--- " + printable((job.folder / name).string(), 400) + "\n" + text + "\n";
    };
    add("job.json", job_text(job));
    for (const auto& [name, text] : files) add(name, text);
    for (const char* step : {"plan", "parts", "merge"})
        if (const std::string arrays = arrays_of_new(job, step); !arrays.empty())
            report += formatted("--- tasks of %s: FIRST and --array\n", step) + arrays + "\n";
    print_report(report + "--- to submit it\n" + shell_text(run_words(job)) + "\n");
}

std::string forecast_text(const TaskForecast& forecast) {
    std::string text = formatted("a task takes about %.2g GB", 1e-9 * forecast.memory);
    if (forecast.seconds) text += " and " + seconds_text(*forecast.seconds);
    return text;
}

int run_submit(const Options& args, const Globals& globals) {
    choice_among("ENGINE", args.engine, {"slurm", "openjd"});
    if (args.dry_run && args.run) fail(ExitCode::usage, "--run", "cannot be combined with --dry-run");
    check_for_plan(args.render, args.groups);
    const Mode& mode = args.render.mode == automatic ? main_mode() : find_mode(args.render.mode, "--mode");
    RenderRequest request = make_request(args.render, mode);
    request.mode = mode.name;
    const Scene scene = load_scene(request.scene_file, load_options(args.render));
    find_camera(scene, request.camera);
    const FarmJob job = job_of(args, scene);
    check_folder(job);
    const TaskForecast forecast = forecast_task(job, scene, request, cancel_flag());
    const FarmFiles files = files_of(job, scene, request, limits_of(job, forecast));
    if (args.dry_run) {
        say_dry(job, files);
        return 0;
    }
    write_job(job, files, args, scene, globals);
    if (!globals.quiet) {
        say(printable(job.folder.string(), 300) + ": " + count_text(job.frames.size(), "frame") + " in " +
            count_text(static_cast<uint64_t>(job.parts), "part") + ", " + job.engine + "; " + forecast_text(forecast));
        say((args.run ? "running: " : "to submit it: ") + printable(shell_text(run_words(job)), 400));
    }
    if (args.run) run(run_words(job));
    return 0;
}
}

Run add_submit(const Command& program) {
    const Command command = program.command("submit", "write a job for a render farm, and submit it with --run");
    auto args = std::make_shared<Options>();
    RenderOptions& render = args->render;
    render.output = "frames.####.exr"; // for the checks of a plan; files go to the folder
    command.option("ENGINE", args->engine, "slurm or openjd (Open Job Description: Deadline Cloud and others)", "")
        .required();
    command.option("SCENE", render.scene, "scene file (.json), or a .gltf, .glb, .vdb or .nvdb by itself", "")
        .required();
    command.option("-o,--output", args->folder, "folder of the job: scripts, plan, parts, frames, logs", "FOLDER")
        .required();
    command.option("--parts", args->parts, "parts per frame (default: 1)", "N");
    command.option("--chunk", args->chunk, "frames per task (default: 1)", "N");
    command.option("--cpus", args->cpus, "processors per task (default: the engine's)", "N");
    command.option("--memory", args->memory, "memory limit per task, MiB (default: from a forecast)", "N");
    command.option("--minutes", args->minutes,
                   "time limit per task, for Slurm (default: from a forecast; with --target-error\n"
                   "the partition's)",
                   "N");
    command.flag("--remove-parts", args->remove_parts, "remove the parts of a frame once it is merged");
    command.flag("--dry-run", args->dry_run, "print what would be written, and write nothing");
    command.flag("--run", args->run, "submit the job: with sbatch, or with openjd run on this machine");
    command.option("--mode", render.mode, "rendering technique (default: march), or auto: chosen for each frame",
                   "NAME");
    add_groups_option(command, args->groups);
    add_planned_options(command, render);
    command.footer(
        "Example: tyndall submit slurm scenes/window.json --frames 1-24 --parts 3 --samples 64 -o out/window\n"
        "With --target-error, or --mode auto, tasks make a plan for each frame first. tyndall status FOLDER\n"
        "shows what is finished, and how to render what is not.");
    return [args](const Globals& globals) { return run_submit(*args, globals); };
}
}

// tyndall prepare: computes what all parts of a plan's frames share, and caches it in files beside the plan.
#include "common.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "render/parts/plan_file.h"
#include "render/parts/prepare.h"
#include "scene/scene.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr const char* usual_size = "32"; // GB
constexpr double gigabyte = 1e9;

struct Options {
    std::string plan, frames, size = usual_size;
    bool clean = false, clean_all = false;
};

const char* name_of(CostKind kind) {
    static constexpr const char* names[] = {"cached", "found", "rebuilt", "no room"};
    return names[static_cast<size_t>(kind)];
}

// Merges entries of the same name and kind.
std::vector<CacheCost> summed(const std::vector<CacheCost>& costs) {
    std::vector<CacheCost> sums;
    for (const CacheCost& cost : costs) {
        const auto same = [&](const CacheCost& sum) { return sum.what == cost.what && sum.kind == cost.kind; };
        if (const auto found = std::ranges::find_if(sums, same); found != sums.end())
            found->seconds += cost.seconds;
        else
            sums.push_back(cost);
    }
    return sums;
}

void say_costs(int frame, const std::vector<CacheCost>& costs) {
    std::string line = formatted("frame %d", frame);
    const std::vector<CacheCost> sums = summed(costs);
    for (const CostKind kind : {CostKind::cached, CostKind::found, CostKind::no_room, CostKind::rebuilt}) {
        std::string list;
        for (const CacheCost& sum : sums)
            if (sum.kind == kind) list += (list.empty() ? " " : ", ") + sum.what + formatted(" %.3f s", sum.seconds);
        if (!list.empty()) line += std::string(line.find(':') == line.npos ? ": " : "; ") + name_of(kind) + list;
    }
    say(line);
}

uint64_t bytes_of(const CacheFolder& folder, const std::string& file) {
    const auto entry = folder.files.find(file);
    return entry == folder.files.end() ? 0 : entry->second.stamp.size;
}

Json frame_json(int frame, const std::vector<CacheCost>& costs, const CacheFolder& folder) {
    const auto thing = [&](const CacheCost& cost) {
        return json_object({{"what", cost.what},
                            {"kind", name_of(cost.kind)},
                            {"seconds", cost.seconds},
                            {"file", cost.file},
                            {"bytes", static_cast<double>(bytes_of(folder, cost.file))}});
    };
    return json_object({{"frame", frame}, {"things", json_list(costs, thing)}});
}

int run_clean(const Options& args, const SavedPlan& plan, const Globals& globals) {
    const uint64_t bytes = clean_prepared(plan, args.clean_all);
    if (globals.json) print_report(json_line({{"plan", args.plan}, {"removed_bytes", static_cast<double>(bytes)}}));
    if (!globals.quiet) say(bytes_text(static_cast<double>(bytes)) + " removed");
    return 0;
}

void check_frames(const SavedPlan& plan, const std::vector<int>& frames) {
    for (const int frame : frames)
        if (!std::ranges::count(plan.request.frames, frame))
            fail(ExitCode::usage, "--frames", formatted("frame %d is not in the plan", frame));
}

int run_prepare(const Options& args, const Globals& globals) {
    const double limit = number_option("--cache-size", args.size, 0, 1e9);
    const SavedPlan plan = load_plan(args.plan);
    if (args.clean || args.clean_all) return run_clean(args, plan, globals);
    const std::vector<int> frames = args.frames.empty() ? plan.request.frames : parse_frames(args.frames);
    check_frames(plan, frames);
    use_planned_isa(plan.request.isa);
    set_stop_remark("; finished files are kept");
    const std::shared_ptr<CacheFolder> folder = open_to_prepare(plan, static_cast<uint64_t>(limit * gigabyte));
    const double start = steady_seconds();
    const Scene scene = load_scene(plan.request.scene_file, {plan.request.light_units});
    check_inputs(plan, scene);
    const CacheCost loading{"scene", steady_seconds() - start};

    Progress progress(globals.progress, "prepare", static_cast<double>(frames.size()), globals.json);
    std::vector<Json> reports;
    bool no_room = false;
    for (size_t i = 0; i < frames.size(); ++i) {
        stop_if_cancelled();
        std::vector<CacheCost> costs = prepare_for_parts(scene, plan, frames[i], folder);
        costs.push_back(loading);
        for (const CacheCost& cost : costs) no_room = no_room || cost.kind == CostKind::no_room;
        reports.push_back(frame_json(frames[i], costs, *folder));
        progress.set(static_cast<double>(i + 1));
        if (!globals.quiet) say_costs(frames[i], costs);
    }
    progress.finish();
    double bytes = 0;
    for (const auto& [name, entry] : folder->files) bytes += static_cast<double>(entry.stamp.size);
    if (globals.json)
        print_report(json_line(
            {{"plan", args.plan}, {"folder", folder->folder.string()}, {"bytes", bytes}, {"frames", reports}}));
    if (globals.quiet) return 0;
    if (no_room) say("note: --cache-size leaves no room for some of it: each part recomputes that");
    say(count_text(frames.size(), "frame") + " prepared in " + seconds_text(steady_seconds() - start) + ": " +
        bytes_text(bytes) + " in " + printable(folder->folder.string()));
    return 0;
}
}

Run add_prepare(const Command& program) {
    const Command command = program.command("prepare", "compute once what all parts of a planned frame share");
    auto args = std::make_shared<Options>();
    command.option("--plan", args->plan, "a plan that tyndall plan --save wrote", "FILE").required();
    command.option("--frames", args->frames, "frames of the plan to prepare (default: all)", "RANGE");
    command.option("--cache-size", args->size,
                   "size limit of the folder (default: 32); what does not fit\nis recomputed by each part", "GB");
    command.flag("--clean", args->clean, "remove what no frame of the plan needs, and prepare nothing");
    command.flag("--clean-all", args->clean_all, "remove all that was prepared, and prepare nothing");
    command.footer("Example: tyndall prepare --plan out/window.plan.json\n"
                   "Fog ready for sampling, light grids and other slow results are stored beside the plan\n"
                   "(out/window.plan.cache); tyndall render --plan finds them by itself. Images stay bit-identical.");
    return [args](const Globals& globals) { return run_prepare(*args, globals); };
}
}

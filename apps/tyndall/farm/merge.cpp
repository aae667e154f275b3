// tyndall merge: combines separately rendered parts into the frames that a single run of their plan renders.
#include "common.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "base/parallel.h"
#include "render/adaptive/planned.h"
#include "render/image/png.h"
#include "render/parts/manifest.h"
#include "render/parts/merge.h"
#include "render/sequence/auto_exposure.h"
#include "scene/input_files.h"
#include "scene/scene.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <thread>

namespace tyndall {
namespace {
struct Options {
    std::vector<std::string> parts;
    std::string output, plan, wait, count, frames;
    bool remove = false, partial = false, png = false;
};

// The files that PARTS name: the files themselves, or with --parts all parts of frames with those names.
std::vector<std::string> files_of(const Options& args) {
    if (args.count.empty()) {
        if (!args.frames.empty()) fail(ExitCode::usage, "--frames", "needs --parts");
        return args.parts;
    }
    Grouping grouping;
    grouping.parts = static_cast<int>(integer_option("--parts", args.count, 1, 1 << 16));
    std::vector<std::string> files;
    for (const std::string& pattern : args.parts) {
        if (has_frame_token(pattern) == args.frames.empty())
            fail(ExitCode::usage, "--frames", "needs a name with ####, and such a name needs --frames");
        for (const int frame : args.frames.empty() ? std::vector{0} : parse_frames(args.frames))
            for (grouping.part = 1; grouping.part <= grouping.parts; ++grouping.part)
                files.push_back(part_name(frame_name(pattern, frame), grouping));
    }
    return files;
}

// Waits at most `seconds` for all files to exist, since some file systems show new files late. Unless `all`, drops
// those that are missing.
std::vector<std::string> wait_for_files(std::vector<std::string> names, double seconds, bool all) {
    const auto missing = [](const std::string& name) {
        std::error_code error;
        return !std::filesystem::exists(name, error);
    };
    const double end = steady_seconds() + seconds;
    while (std::ranges::any_of(names, missing) && steady_seconds() < end) {
        stop_if_cancelled();
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    if (!all) std::erase_if(names, missing);
    return names;
}

std::map<int, std::vector<PartFile>> read_parts(const std::vector<std::string>& names) {
    std::vector<std::optional<PartFile>> parts(names.size());
    parallel_for(static_cast<int64_t>(names.size()), [&](int64_t i) {
        stop_if_cancelled();
        parts[static_cast<size_t>(i)] = read_part(names[static_cast<size_t>(i)]);
    });
    std::map<int, std::vector<PartFile>> frames;
    for (std::optional<PartFile>& part : parts) frames[part->frame].push_back(std::move(*part));
    return frames;
}

Json frame_json(int frame, const std::string& file, const FrameStats& stats, const PartGroups& groups) {
    JsonMembers members{{"frame", frame},
                        {"file", file},
                        {"groups", groups.groups},
                        {"share", groups.share},
                        {"samples", stats.samples}};
    if (const std::optional<Noise> error = stats.error()) {
        members.emplace_back("error", error->error);
        members.emplace_back("bound", error->bound);
    }
    members.emplace_back("non_finite", static_cast<double>(stats.non_finite));
    return json_object(std::move(members));
}

// Says how a frame that misses the plan's target can reach it.
void say_lacking(const SavedPlan& plan, double lacking, int groups, int frame, const std::string& file) {
    const std::string place = formatted("frame %d: ", frame);
    if (lacking > 1e6)
        return say(place +
                   "more samples do not help: steps, maps or grids are too coarse; plan again with a finer quality");
    const int planned = plan.request.grouping.groups;
    say(place + formatted("lacks %g groups: tyndall render --plan ", lacking) +
        quoted_for_shell(plan.request.grouping.plan_file.string()) + " -o " + quoted_for_shell(file) +
        formatted(" --frames %d --more %g", frame, lacking) + (groups > planned ? formatted("@%d", groups) : ""));
}

// A merge of all frames, and its outcome.
struct Merge {
    const Options& args;
    const Globals& globals;
    SavedPlan plan{};
    std::vector<Json> reports{};
    uint64_t non_finite = 0;
    int missed = 0, partial = 0; // frames

    void say(const std::string& line) const {
        if (!globals.quiet) tyndall::say(line);
    }
};

void say_merged(const Merge& merge, int frame, const std::string& file, const MergedFrame& result,
                const PartGroups& groups, size_t parts, double seconds) {
    std::string noise = ", noise unknown";
    if (const auto error = result.stats.error())
        noise = formatted(", %s %.3g, at most %.3g", result.stats.is_noise_alone() ? "noise" : "error", error->error,
                          error->bound);
    else if (groups.gap.empty())
        noise.clear();
    merge.say(formatted("frame %d from %s in ", frame, count_text(parts, "part").c_str()) + seconds_text(seconds) +
              " -> " + printable(file) + noise + formatted(", %d samples per pixel", result.stats.samples));
    if (groups.gap.empty()) return;
    std::string line = formatted("frame %d is incomplete: %s; %.3g of the samples are present", frame,
                                 groups.gap.c_str(), groups.share);
    if (result.empty_pixels > 0)
        line += ", and none for " + count_text(static_cast<uint64_t>(result.empty_pixels), "pixel");
    merge.say(line);
}

// One exposure for all PNGs, where the scene sets none: that of a single run.
void measure_exposure(Merge& merge, const Scene& scene) {
    RenderPlan& plan = merge.plan.plan;
    if (!merge.args.png || !needs_auto_exposure(scene, merge.plan.request)) return;
    plan.exposure = automatic_exposure(scene, merge.plan.request, orders_of(*plan.mode, plan.settings));
    merge.say(formatted("PNGs: automatic exposure, %+.1f EV", *plan.exposure));
}

void merge_one(Merge& merge, const Scene& scene, int frame, const std::vector<PartFile>& parts,
               const PartGroups& groups) {
    const double start = steady_seconds();
    const std::string file = frame_name(merge.args.output, frame);
    const MergedFrame result = merge_frame(parts, groups, scene, merge.plan);
    const RenderRequest& request = merge.plan.request;
    write_exr(file, result.layers, result.provenance, request.exr);
    if (merge.args.png)
        write_png(png_name(file), stored_color(result.layers, request.exr),
                  display_of(scene, request, merge.plan.plan, frame));
    const bool whole = groups.gap.empty();
    const double lacking = whole ? missing_groups(merge.plan.request.grouping.error, result.stats, groups.groups) : 0;
    if (lacking > 0 && !merge.globals.quiet) say_lacking(merge.plan, lacking, groups.groups, frame, file);
    if (merge.args.remove && whole && lacking == 0) // these parts are needed again when groups are added
        for (const PartFile& part : parts) std::filesystem::remove(part.file);
    merge.non_finite += result.stats.non_finite, merge.missed += lacking > 0, merge.partial += !whole;
    merge.reports.push_back(frame_json(frame, file, result.stats, groups));
    say_merged(merge, frame, file, result, groups, parts.size(), steady_seconds() - start);
}

int outcome(const Merge& merge) {
    const std::string scene = merge.plan.request.scene_file.string();
    if (merge.non_finite > 0)
        fail(ExitCode::non_finite, scene,
             count_text(merge.non_finite, "sample") + " were not finite numbers and were ignored");
    if (merge.partial > 0)
        fail(ExitCode::differs, scene, "parts are missing for " + count_text(merge.partial, "frame"));
    if (merge.missed > 0)
        fail(ExitCode::differs, scene,
             formatted("all frames were written, but the error of %d of them may be larger than %g", merge.missed,
                       merge.plan.request.target_error));
    return 0;
}

// Parts of several frames but one output name: most likely a part of another frame is given by mistake.
[[noreturn]] void refuse_stray(const std::map<int, std::vector<PartFile>>& frames) {
    const auto parts = [](const auto& frame) { return frame.second.size(); };
    const auto &stray = *std::ranges::min_element(frames, {}, parts),
               &others = *std::ranges::max_element(frames, {}, parts);
    refuse(stray.second[0].file.string(),
           formatted("belongs to frame %d, others to frame %d: --output needs #### for several frames", stray.first,
                     others.first));
}

int run_merge(const Options& args, const Globals& globals) {
    check_pattern(args.output, ".exr", false);
    const double wait = args.wait.empty() ? 0 : number_option("--wait", args.wait, 0, 86400);
    const std::vector<std::string> names = wait_for_files(files_of(args), wait, !args.partial);
    if (names.empty()) fail(ExitCode::unreadable, args.parts[0], "no such file, and no other part exists");
    std::map<int, std::vector<PartFile>> frames = read_parts(names);
    if (frames.size() > 1 && !has_frame_token(args.output)) refuse_stray(frames);
    const PartFile& first = frames.begin()->second[0];
    Merge merge{args, globals};
    merge.plan = load_plan(args.plan.empty() ? first.plan_file : std::filesystem::path(args.plan));
    merge.plan.request.output = args.output;
    use_planned_isa(merge.plan.request.isa);
    OutputPaths places;
    std::map<int, PartGroups> groups;
    for (auto& [frame, parts] : frames) {
        groups[frame] = check_parts(parts, merge.plan);
        if (!groups[frame].gap.empty() && !args.partial) refuse(groups[frame].beside.string(), groups[frame].gap);
        check_prepared(merge.plan, frame);
        const std::string file = frame_name(args.output, frame);
        places.check(std::filesystem::path(file));
        if (args.png) places.check(png_name(file));
    }
    const Scene scene = load_scene(merge.plan.request.scene_file, {merge.plan.request.light_units});
    check_inputs(merge.plan, scene);
    spare_files(scene, places);
    for (const std::string& part : names) places.spare(part);
    measure_exposure(merge, scene);

    for (const auto& [frame, parts] : frames) {
        stop_if_cancelled();
        merge_one(merge, scene, frame, parts, groups[frame]);
    }
    if (globals.json) print_report(json_line({{"frames", merge.reports}}));
    return outcome(merge);
}
}

Run add_merge(const Command& program) {
    const Command command = program.command("merge", "merge the parts of frames, bit-identical to a single run");
    auto args = std::make_shared<Options>();
    command.options("PARTS", args->parts, "EXR parts that tyndall render --plan ... --part i/N wrote", "").required();
    command.option("-o,--output", args->output, "files to write; #### stands for the frame number", "out.####.exr")
        .required();
    command.option("--parts", args->count, "parts per frame; PARTS are then the names that render -o was given", "N");
    command.option("--frames", args->frames, "with --parts: the frames to merge, where names have ####", "RANGE");
    command.option("--plan", args->plan, "the plan, if it has moved since the parts were rendered", "FILE");
    command.option("--wait", args->wait,
                   "wait at most this many seconds for named parts that do not exist yet: a\n"
                   "shared file system may show new files late (default: 0)",
                   "SECONDS");
    command.flag("--png", args->png, "also write images for viewing (8-bit sRGB)");
    command.flag("--partial", args->partial,
                 "merge the existing parts even if some are missing: more noise, and exit\n"
                 "code 1");
    command.flag("--remove-parts", args->remove,
                 "remove the parts of a frame once it is written and\nmeets its target");
    command.footer(
        "Example: tyndall merge out/window.0001.part-*.exr -o out/window.0001.exr\n"
        "Frames with all their parts: tyndall merge out/window.####.exr --parts 8 --frames 1-24 -o "
        "out/window.####.exr\n"
        "Every sample must be present exactly once: a part that is missing, duplicate, damaged or made from\n"
        "other inputs ends it with exit code 3 and the name of the file, and nothing is written.");
    return [args](const Globals& globals) { return run_merge(*args, globals); };
}
}

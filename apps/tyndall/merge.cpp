// tyndall merge: parts of frames, rendered apart, to the frames that one run of their plan renders.
#include "common.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "render/adaptive/planned.h"
#include "render/parts/manifest.h"
#include "render/parts/merge.h"
#include "scene/scene.h"

#include <algorithm>
#include <map>

namespace tyndall {
namespace {
struct Options {
    std::vector<std::string> parts;
    std::string output, plan;
    bool remove = false;
};

std::map<int, std::vector<PartFile>> read_parts(const std::vector<std::string>& names) {
    std::map<int, std::vector<PartFile>> frames;
    for (const std::string& name : names) {
        stop_if_cancelled();
        PartFile part = read_part(name);
        frames[part.frame].push_back(std::move(part));
    }
    return frames;
}

Json frame_json(int frame, const std::string& file, const FrameStats& stats, int groups) {
    JsonMembers members{{"frame", frame}, {"file", file}, {"groups", groups}, {"samples", stats.samples}};
    if (const std::optional<Noise> error = stats.error()) {
        members.emplace_back("error", error->error);
        members.emplace_back("bound", error->bound);
    }
    members.emplace_back("non_finite", static_cast<double>(stats.non_finite));
    return json_object(std::move(members));
}

// How a frame that misses the plan's target gets there.
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

int run_merge(const Options& texts, const Globals& globals) {
    check_pattern(texts.output, ".exr", false);
    std::map<int, std::vector<PartFile>> frames = read_parts(texts.parts);
    if (frames.size() > 1) check_pattern(texts.output, ".exr", true);
    const PartFile& first = frames.begin()->second[0];
    SavedPlan plan = load_plan(texts.plan.empty() ? first.plan_file : std::filesystem::path(texts.plan));
    plan.request.output = texts.output;
    OutputPlaces places;
    std::map<int, int> groups;
    for (auto& [frame, parts] : frames) {
        groups[frame] = check_parts(parts, plan);
        check_prepared(plan, frame);
        places.check(std::filesystem::path(frame_name(texts.output, frame)));
    }
    const Scene scene = load_scene(plan.request.scene_file, {plan.request.light_units});
    check_inputs(plan, scene);

    std::vector<Json> reports;
    uint64_t non_finite = 0;
    int missed = 0;
    for (auto& [frame, parts] : frames) {
        stop_if_cancelled();
        const double start = steady_seconds();
        const std::string file = frame_name(texts.output, frame);
        std::vector<std::filesystem::path> merged;
        for (const PartFile& part : parts) merged.push_back(part.file);
        const MergedFrame result = merge_frame(std::move(parts), groups[frame], scene, plan);
        write_exr(file, result.layers, result.provenance, plan.request.exr);
        const double lacking = groups_lacking(plan.request.grouping.error, result.stats, groups[frame]);
        if (lacking > 0 && !globals.quiet) say_lacking(plan, lacking, groups[frame], frame, file);
        if (texts.remove && lacking == 0) // where more groups come, these parts are needed again
            for (const std::filesystem::path& part : merged) std::filesystem::remove(part);
        non_finite += result.stats.non_finite, missed += lacking > 0;
        reports.push_back(frame_json(frame, file, result.stats, groups[frame]));
        std::string noise;
        if (const auto error = result.stats.error())
            noise = formatted(", noise %.3g, at most %.3g", error->error, error->bound);
        if (!globals.quiet)
            say(formatted("frame %d from %s in ", frame, count_text(merged.size(), "part").c_str()) +
                seconds_text(steady_seconds() - start) + " -> " + printable(file) + noise +
                formatted(", %d samples per pixel", result.stats.samples));
    }
    if (globals.json) print_report(json_line({{"frames", reports}}));
    if (non_finite > 0)
        fail(ExitCode::non_finite, plan.request.scene_file.string(),
             count_text(non_finite, "sample") + " were not finite numbers and were left out");
    if (missed > 0)
        fail(ExitCode::differs, plan.request.scene_file.string(),
             formatted("all frames were written, but the error of %d of them may be larger than %g", missed,
                       plan.request.target_error));
    return 0;
}
}

Run add_merge(const Command& program) {
    const Command command = program.command("merge", "put the parts of frames together, to the bits of one run");
    auto texts = std::make_shared<Options>();
    command.options("PARTS", texts->parts, "EXR parts that tyndall render --plan ... --part i/N wrote", "").required();
    command.option("-o,--output", texts->output, "files to write; #### stands for the frame number", "out.####.exr")
        .required();
    command.option("--plan", texts->plan, "the plan, where it is not where the parts were rendered by it", "FILE");
    command.flag("--remove-parts", texts->remove,
                 "remove the parts of a frame once it is written and\nmeets its target");
    command.footer("Example: tyndall merge out/window.0001.part-*.exr -o out/window.0001.exr\n"
                   "Every sample has to be there exactly once: parts that are missing, doubled, damaged or of other\n"
                   "inputs end it with exit code 3 and the name of the file, and nothing is written.");
    return [texts](const Globals& globals) { return run_merge(*texts, globals); };
}
}

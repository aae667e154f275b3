// tyndall render: renders the frames of a scene to OpenEXR files, and PNGs for viewing.
#include "base/clock.h"
#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "base/io/output.h"
#include "base/text.h"
#include "common.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/parts/manifest.h"
#include "render/parts/part_file.h"
#include "render/parts/plan_file.h"
#include "render/sequence/auto_exposure.h"
#include "render/sequence/sequence.h"
#include "rendering/automatic.h"
#include "rendering/remarks.h"
#include "rendering/render_options.h"
#include "rendering/sheet.h"
#include "scene/input_files.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/moment.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <span>
#include <utility>

namespace tyndall {
namespace {
void choose_frames(const Scene& scene, const std::string& order, RenderRequest& request) {
    if (request.frames.empty()) request.frames = frames_between(scene.first_frame, scene.last_frame);
    if (order == "spread") request.frames = spread_frames(request.frames);
    check_pattern(request.output, ".exr", request.frames.size() > 1);
}

// Rounds the sample count to the equal batches that measuring noise needs. Notes that, and rounding to half floats.
void settle_noise(const RenderRequest& request, RenderPlan& plan, const Globals& globals) {
    if (request.grouping.groups > 0) return; // the plan has settled it
    const bool first_round = request.target_error > 0 && request.time_budget == 0 && is_unbiased(*plan.mode);
    if (!(has_goal(request) ? first_round : measures_noise(request))) return say_rounding(request, globals);
    int& samples = plan.settings.pixel.samples;
    const int asked = std::exchange(samples, batched_samples(samples));
    if (globals.quiet) return;
    if (samples != asked)
        say(formatted("note: %d camera rays per pixel instead of %d: noise is measured in %d equal batches", samples,
                      asked, noise_batches));
    say_rounding(request, globals);
}

// A request with its plan and report.
struct Rendered {
    RenderRequest request;
    RenderPlan plan;
    RenderReport report;
};

std::string stats_name(const RenderOptions& args, const RenderRequest& request, bool several) {
    return args.stats.empty() || !several ? args.stats : with_word(args.stats, request.mode);
}

// What the requests of several modes share.
struct Common {
    Snapshot first;                 // the first frame, to reuse its fog and surfaces; empty unless it is the only frame
    std::optional<double> exposure; // of PNGs, if measured
};

// Measures one exposure for the PNGs of all modes, with the most scattering orders that any of them has.
void measure_exposure(const Scene& scene, std::span<const RenderRequest> requests, const Snapshot& first,
                      Common& common, const Globals& globals) {
    const RenderRequest& request = requests[0];
    const bool pngs = request.png || requests.size() > 1;
    if (common.exposure || !pngs || !needs_auto_exposure(scene, request)) return;
    int orders = 1;
    for (const RenderRequest& one : requests) orders = std::max(orders, orders_of(find_mode(one.mode), one.settings));
    common.exposure = automatic_exposure(scene, request, orders, &first);
    if (!globals.quiet)
        say(formatted("PNGs: automatic exposure, %+.1f EV (--exposure sets another)", *common.exposure));
}

// Renders the frames of one of the requests, writes its statistics file and prints a summary.
Rendered render_frames(const Scene& scene, std::span<const RenderRequest> requests, const RenderRequest& request,
                       const RenderOptions& args, Common& common, const Globals& globals) {
    const bool several = requests.size() > 1;
    LoadedFrame first = load_first_frame(scene, request, &common.first);
    Rendered result{request,
                    args.mode == automatic ? chosen_plan(scene, request, first.snapshot, globals)
                                           : requested_plan(request),
                    {}};
    const std::vector<std::string> absent = drop_absent_layers(scene, result.plan, result.request);
    if (!globals.quiet && !absent.empty())
        say("note: no layer " + joined(absent, ", ") + ": the scene's fog has no such light");
    settle_noise(request, result.plan, globals);
    measure_exposure(scene, requests, first.snapshot, common, globals);
    result.plan.exposure = common.exposure;
    common.first = request.frames.size() == 1 ? first.snapshot : Snapshot{};
    common.first.cache = nullptr; // the time that a mode takes must not depend on the one before it
    const bool measured = !globals.quiet || globals.json || !args.stats.empty();
    Limitations limitations = limitations_of(scene, request, result.plan, first.snapshot, measured);
    if (request.history > 0 && result.plan.mode->uses_history && is_chromatic(first.snapshot))
        fail(ExitCode::usage, "--history", "cannot be combined with fog whose extinction differs between the channels");
    say_before(scene, first.snapshot, limitations, args.settings, request, *result.plan.mode, globals);

    Progress progress(globals.progress, several ? request.mode : "render", static_cast<double>(request.frames.size()),
                      globals.json);
    RenderReport& report = result.report;
    report = render_sequence(scene, result.request, result.plan, progress, cancel_flag(), &first);
    if (!report.cancelled) progress.finish();
    say_files_found(request, globals);
    // For the statistics only: a frame's header must not depend on which frame was the first.
    report.limitations = std::move(limitations);
    if (const std::string file = stats_name(args, request, several); !file.empty())
        write_file_atomically(file, stats_json(report, result.request, result.plan));
    if (!globals.quiet) {
        for (const std::string& note : report.notes) say("note: " + printable(note, 460));
        say_summary(report, request);
    }
    return result;
}

int outcome(const std::vector<Rendered>& all, const std::string& scene) {
    uint64_t non_finite = 0;
    for (const Rendered& one : all) non_finite += one.report.non_finite;
    for (const Rendered& one : all)
        if (non_finite == 0 && one.report.late > 0)
            fail(ExitCode::differs, scene,
                 "all frames were written, but took " + seconds_text(one.report.late) +
                     " more than --time-budget: loading, one ray per pixel and writing need that");
    for (const Rendered& one : all)
        if (non_finite == 0 && one.report.missed)
            fail(ExitCode::differs, scene,
                 formatted("all frames were written, but the error of %d of them may be larger than %g",
                           one.report.missed, one.request.target_error));
    if (non_finite == 0) return 0;
    fail(ExitCode::non_finite, scene,
         "all frames were written, but " + count_text(non_finite, "sample") +
             " were not finite numbers and were ignored");
}

std::string sheet_name(const RenderOptions& args, int frame) {
    return std::filesystem::path(frame_name(with_word(args.output, "modes"), frame)).replace_extension(".png").string();
}

// Writes one PNG per frame with the images of all modes, their times, and their errors against a reference.
void write_sheets(const Scene& scene, const std::vector<Rendered>& all, const RenderOptions& args,
                  const Globals& globals) {
    for (const int frame : all[0].request.frames) {
        std::vector<SheetEntry> entries;
        for (const Rendered& one : all) {
            const auto found = std::ranges::find(one.report.frames, frame, &FrameReport::frame);
            if (found == one.report.frames.end()) return; // cancelled
            const FrameStats& stats = found->stats;
            std::string times = "kept";
            if (!found->kept)
                times = seconds_text(stats.prepare_seconds + stats.render_seconds) + ", fog " +
                        seconds_text(stats.fog_seconds);
            entries.push_back({std::string(one.plan.mode->name), times, found->file});
        }
        const Display display = display_of(scene, all[0].request, all[0].plan, frame);
        write_sheet(sheet_name(args, frame), entries, args.sheet_reference, frame, display);
    }
    if (!globals.quiet) say("to view: " + printable(sheet_name(args, all[0].request.frames[0])));
}

// The requests of all modes asked for; several modes have separate output files.
std::vector<RenderRequest> make_requests(const RenderOptions& args) {
    std::vector<RenderRequest> requests;
    // With --mode auto, the main renderer stands in until the scene is loaded.
    const std::vector<const Mode*> asked =
        modes_option("--mode", args.mode == automatic ? std::string(main_mode().name) : args.mode);
    for (const Mode* mode : asked) {
        requests.push_back(make_request(args, *mode));
        requests.back().mode_open = args.mode == automatic;
        if (asked.size() > 1) requests.back().output = with_word(args.output, mode->name);
    }
    return requests;
}

// The requests of a plan, or of the command line alone.
std::vector<RenderRequest> requests_of(const RenderOptions& args, std::optional<SavedPlan>& plan) {
    if (args.scene.empty() && args.plan.empty())
        fail(ExitCode::usage, "SCENE", "a scene file or --plan is required (tyndall render --help)");
    if (args.output.empty()) fail(ExitCode::usage, "--output", "is required (tyndall render --help)");
    if (!args.plan.empty()) return {planned_request(args, plan.emplace())};
    for (const auto& [name, text] : {std::pair{"--part", &args.part},
                                     {"--more", &args.more},
                                     {"--checkpoint", &args.checkpoint},
                                     {"--cache-local", &args.cache_local}})
        if (!text->empty()) fail(ExitCode::usage, name, "needs --plan");
    return make_requests(args);
}

// Opens the files that tyndall prepare made for the plan's frames; null when there are none.
std::shared_ptr<CacheFolder> prepared_files(const RenderOptions& args, const SavedPlan& plan,
                                            const std::vector<int>& frames, const Globals& globals) {
    std::vector<std::string> notes;
    std::shared_ptr<CacheFolder> files = open_prepared(plan, frames, args.cache_local, notes);
    if (!files && !args.cache_local.empty()) notes.push_back("--cache-local has no effect: nothing was prepared");
    if (!globals.quiet)
        for (const std::string& note : notes) say("note: " + printable(note, 460));
    return files;
}

// Throws Error for options that contradict each other and files that cannot be written.
void check_requests(const RenderOptions& args, std::vector<RenderRequest>& requests, OutputPaths& places) {
    choice_among("--order", args.order, {"listed", "spread"});
    if (requests.size() == 1 && !args.sheet_reference.empty())
        fail(ExitCode::usage, "--reference", "needs several modes; for one image use tyndall compare");
    for (const RenderRequest& request : requests) {
        if (!request.frames.empty())
            places.check(request.output, request.frames);
        else
            places.check(std::filesystem::path(frame_name(request.output, 1)));
        if (!args.stats.empty()) places.check(std::filesystem::path(stats_name(args, request, requests.size() > 1)));
    }
}

// The checks that need the scene. Also sets the frames of the requests.
void check_with_scene(const Scene& scene, const RenderOptions& args, std::vector<RenderRequest>& requests,
                      OutputPaths& places) {
    const auto size_of = [&](const RenderRequest& request) {
        return request.resolution.x > 0 ? request.resolution : scene.resolution;
    };
    for (RenderRequest& request : requests) {
        choose_frames(scene, args.order, request);
        check_outputs(scene, request, places);
        find_camera(scene, request.camera);
        check_crop(request, size_of(request));
        if (is_part(request.grouping))
            range_of(request.grouping, find_mode(request.mode),
                     view_of(scene, request, request.settings, request.frames[0]));
    }
    if (!args.sheet_reference.empty())
        check_sheet_reference(args.sheet_reference, requests[0].frames, size_of(requests[0]));
    if (requests.size() > 1)
        for (const int frame : requests[0].frames) places.check(std::filesystem::path(sheet_name(args, frame)));
    spare_files(scene, places);
    if (!args.plan.empty()) places.spare(args.plan);
}

int run_render(const RenderOptions& args, const Globals& globals) {
    std::optional<SavedPlan> saved;
    std::vector<RenderRequest> requests = requests_of(args, saved);
    const bool several = requests.size() > 1, part = is_part(requests[0].grouping);
    const LoadOptions options = saved ? LoadOptions{saved->request.light_units} : load_options(args);
    for (RenderRequest& request : requests) request.light_units = options.light_units;
    OutputPaths places;
    check_requests(args, requests, places);
    constexpr unsigned to_write_checkpoint = 25; // up to 4 GiB; engines of farms grant 30 seconds and more
    set_stop_remark(part ? "; finished work is kept, --resume continues"
                         : "; finished frames are kept, --resume continues",
                    part ? to_write_checkpoint : 1);
    const Scene scene = load_scene(requests[0].scene_file, options);
    if (saved) check_inputs(*saved, scene);
    if (saved) requests[0].files = prepared_files(args, *saved, requests[0].frames, globals);
    stop_if_cancelled();
    check_with_scene(scene, args, requests, places);

    std::vector<Rendered> all;
    std::string reports;
    Common common;
    for (RenderRequest& request : requests) {
        request.started = all.empty() ? program_start() : steady_seconds();
        all.push_back(render_frames(scene, requests, request, args, common, globals));
        reports += (reports.empty() ? "" : ",\n") + stats_json(all.back().report, all.back().request, all.back().plan);
        stop_if_cancelled();
    }
    if (several) write_sheets(scene, all, args, globals);
    if (!several && !globals.quiet && !is_part(all[0].request.grouping)) say_look(all[0].request);
    if (globals.json) print_report((several ? "[" + reports + "]" : reports) + "\n");
    return outcome(all, requests[0].scene_file.string());
}
}

Run add_render(const Command& program) {
    const Command command = program.command("render", "light a scene and render its frames to OpenEXR files");
    auto args = std::make_shared<RenderOptions>();
    add_render_options(command, *args);
    command.footer("Example: the first second at full HD, with PNGs to look at\n"
                   "  tyndall render scenes/window.json -o out/window.####.exr --frames 1-24 --res 1920x1080 --png\n"
                   "A quick look first: --quality draft --res 480x270 --frames 1\n"
                   "Light is in candela and lux, lengths in meters, colors linear Rec.709.");
    return [args](const Globals& globals) { return run_render(*args, globals); };
}
}

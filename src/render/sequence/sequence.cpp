// The pipeline over frames: one is rendered while the one before is written and the one after is loaded.
#include "render/sequence/sequence.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/cache_folder.h"
#include "base/io/frames.h"
#include "base/parallel.h"
#include "base/text.h"
#include "modes/history.h"
#include "modes/mode.h"
#include "render/adaptive/planned.h"
#include "render/adaptive/to_target.h"
#include "render/image/png.h"
#include "render/parts/part_file.h"
#include "render/sequence/auto_exposure.h"
#include "render/sequence/job.h"
#include "render/sequence/provenance.h"
#include "render/sequence/resume.h"
#include "scene/light.h"
#include "scene/scene.h"

#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace tyndall {
namespace {

// A frame ready to render, and after that ready to write.
struct Work {
    size_t index = 0; // in the request's frames
    FrameReport report;
    std::string hash;
    View view;
    Snapshot snapshot;
    Layers layers;
    FramePart part{};               // instead of layers, where one was asked for
    std::optional<RenderPlan> by{}; // rendered by, where that is not the sequence's
};

// What the stages share.
struct Pipeline {
    const Scene& scene;
    const RenderRequest& request;
    const RenderPlan& plan;
    Progress& progress;
    std::atomic<bool>& cancel;
    std::vector<std::string> channels; // of every file
    LoadedFrame first;                 // of the sequence, until it is taken
    std::shared_ptr<FileHashes> files = first.files;
    size_t next = 0; // index of the first frame not yet looked at
    RenderReport report{};
    std::mutex reporting{};       // held to change the report
    std::atomic<int> settled = 0; // frames rendered or kept
    int rendered = 0;             // frames
};

// Writing is likely to take so long.
double seconds_to_write(const RenderRequest& request, const View& view) {
    const double pixels = static_cast<double>(view.size.x) * view.size.y;
    return 0.01 + pixels * (request.png ? 1e-6 : 5e-7);
}

// Until the next frame has to be rendered; 0 where there is no limit. What earlier frames left, it may use.
double seconds_left(const Pipeline& pipeline, const View& view) {
    const RenderRequest& request = pipeline.request;
    if (request.time_budget == 0) return 0;
    const double end = request.started + request.time_budget * (pipeline.rendered + 1);
    constexpr double safe = 0.96; // something may hold the process up
    return std::max(safe * (end - steady_seconds() - seconds_to_write(request, view)), 1e-3);
}

// The PNG beside a frame's EXR.
void write_picture(const Pipeline& pipeline, const Image<vec3>& color, FrameReport& report) {
    const Display display = display_of(pipeline.scene, pipeline.request, pipeline.plan, report.frame);
    write_png(png_name(report.file), color, display);
    report.exposure = display.exposure;
}

// The error again, with its frame before its place and the reason kept whole.
[[noreturn]] void fail_in_frame(int frame, const Error& error) {
    const std::string text = error.what(), name = "frame " + std::to_string(frame);
    const size_t split = text.rfind(": ", 200);
    if (split == text.npos) fail(error.code, name, text);
    fail(error.code, name + ": " + text.substr(0, split), text.substr(split + 2));
}

void say(const Pipeline& pipeline, const Work& work, const std::string& what) {
    pipeline.progress.line("frame " + std::to_string(work.report.frame) + " (" + std::to_string(work.index + 1) + "/" +
                           std::to_string(pipeline.request.frames.size()) + ") " + what);
}

WantedFrame wanted_frame(const Pipeline& pipeline, const Work& work) {
    const View& view = work.view;
    const bool cropped = view.crop_low != view.crop_high;
    return {view.size, cropped ? view.crop_low : ivec2(0), cropped ? view.crop_high - view.crop_low : view.size,
            pipeline.channels, work.hash};
}

// Keeps a frame that is already there and right; its PNG is made anew, since that carries no hash.
bool keep(Pipeline& pipeline, Work& work) {
    std::string why;
    if (is_part(pipeline.request.grouping)) {
        work.report.kept = is_finished_part(work.report.file, work.hash, pipeline.request.grouping, why);
        if (!why.empty()) say(pipeline, work, "is rendered again: " + why);
        if (work.report.kept) say(pipeline, work, "kept " + work.report.file);
        return work.report.kept;
    }
    const std::optional<ExrFile> exr = finished_frame(work.report.file, wanted_frame(pipeline, work), why);
    if (!exr) {
        if (!why.empty()) say(pipeline, work, "is rendered again: " + why);
        return false;
    }
    if (pipeline.request.png) write_picture(pipeline, color_of(*exr), work.report);
    work.report.kept = true;
    read_noise(exr->attributes, work.report.stats);
    say(pipeline, work, "kept " + work.report.file);
    return true;
}

// The snapshot of a frame, sharing with the one before; of the first one perhaps the one that is there.
LoadedFrame loaded(Pipeline& pipeline, int frame, const Snapshot* previous) {
    LoadedFrame first = std::exchange(pipeline.first, {});
    if (first.snapshot.scene == &pipeline.scene && first.snapshot.frame == frame) return first;
    const double start = steady_seconds();
    if (!previous) previous = &first.snapshot;
    Snapshot snapshot = make_snapshot(pipeline.scene, moment_of(pipeline.scene, frame), previous,
                                      pipeline.request.missing, pipeline.request.files);
    return {std::move(snapshot), steady_seconds() - start};
}

void report_frame(Pipeline& pipeline, const Work& work) {
    const std::scoped_lock lock(pipeline.reporting);
    pipeline.report.non_finite += work.report.stats.non_finite;
    pipeline.report.frames.push_back(work.report);
}

void report_notes(Pipeline& pipeline, const Snapshot& snapshot) {
    const std::scoped_lock lock(pipeline.reporting);
    for (const std::string& note : snapshot.notes)
        if (!std::ranges::count(pipeline.report.notes, note)) pipeline.report.notes.push_back(note);
}

// The next frame that has to be rendered; kept ones on the way are reported.
std::optional<Work> load_next(Pipeline& pipeline, const Snapshot* previous) {
    while (pipeline.next < pipeline.request.frames.size() && !pipeline.cancel) {
        const double start = steady_seconds();
        Work work;
        work.index = pipeline.next++;
        const int frame = work.report.frame = pipeline.request.frames[work.index];
        work.report.file = frame_name(pipeline.request.output, frame);
        if (is_part(pipeline.request.grouping))
            work.report.file = part_name(work.report.file, pipeline.request.grouping);
        try {
            work.view = view_of(pipeline.scene, pipeline.request, pipeline.plan.settings, frame);
            work.hash = frame_hash(pipeline.scene, pipeline.request, pipeline.plan, work.view, *pipeline.files);
            if (pipeline.request.resume && keep(pipeline, work)) {
                work.report.load_seconds = steady_seconds() - start;
                report_frame(pipeline, work);
                pipeline.progress.set(++pipeline.settled);
                continue;
            }
            work.report.load_seconds = steady_seconds() - start;
            LoadedFrame frame_now = loaded(pipeline, frame, previous);
            work.report.load_seconds += frame_now.seconds;
            work.snapshot = std::move(frame_now.snapshot);
        } catch (const Error& error) {
            fail_in_frame(frame, error);
        }
        report_notes(pipeline, work.snapshot);
        return work;
    }
    return {};
}

// Shows the mode the frames before this one, so that a frame depends on nothing but the scene and its number. Before
// the scene's first frame time stands still. Each shares with the last; the first with what the sequence's frame before
// kept.
void warm_up(const Pipeline& pipeline, Work& work, History& history) {
    const int frame = work.report.frame, first = std::min(pipeline.scene.first_frame, frame);
    Snapshot previous = work.snapshot;
    previous.cache = work.snapshot.cache_before;
    for (int back = pipeline.request.history; back > 0 && !pipeline.cancel; --back) {
        const int earlier = std::max(frame - back, first);
        Snapshot snapshot =
            make_snapshot(pipeline.scene, moment_of(pipeline.scene, earlier), &previous, pipeline.request.missing);
        View view = view_of(pipeline.scene, pipeline.request, pipeline.plan.settings, earlier);
        view.frame = frame - back;
        pipeline.plan.mode->prepare(view, snapshot, pipeline.plan.settings, &history);
        previous = std::move(snapshot);
    }
    work.snapshot.cache_before = previous.cache;
}

// What a frame will take, where that is long enough to be told.
void say_forecast(const Pipeline& pipeline, const Work& work, double seconds) {
    constexpr double long_work = 10;
    if (seconds < long_work) return;
    if (seconds == infinity)
        return say(pipeline, work, "will not get to the error that is wanted: it may be too small");
    say(pipeline, work, "will take about " + seconds_text(seconds));
}

// Whether a technique that was chosen for the first frame missed the target.
bool missed_by_plan(const RenderPlan& plan, const RenderRequest& request, const FrameStats& stats) {
    return plan.wanted && plan.mode != &main_mode() && request.time_budget == 0 && stats.integrator &&
           stats.error()->bound > request.target_error;
}

void render_by_main_mode(Pipeline& pipeline, Work& work, FrameOptions options) {
    const RenderPlan& plan = pipeline.plan;
    say(pipeline, work,
        std::string(plan.mode->name) + " is too far off: rendered again with " + std::string(main_mode().name));
    work.report.mode = main_mode().name;
    work.by = RenderPlan{&main_mode(), *plan.wanted, plan.certificate, nullptr, plan.wanted};
    Goal goal{pipeline.request.target_error, 0, pipeline.request.quality};
    if (work.index == 0) goal.choice = plan.main;
    options.history = nullptr;
    work.layers =
        render_to_target(main_mode(), work.view, work.snapshot, work.by->settings, goal, options, work.report.stats);
}

// The part of the frame's samples that was asked for, from its last checkpoint on.
void render_own_part(const Pipeline& pipeline, const FrameOptions& options, Work& work) {
    const RenderRequest& request = pipeline.request;
    const Mode& mode = *pipeline.plan.mode;
    const std::filesystem::path file = checkpoint_name(work.report.file);
    std::string why;
    Checkpoints checkpoints{request.checkpoint_seconds};
    if (request.resume) checkpoints.last = read_checkpoint(file, work.hash, request.grouping, why);
    if (checkpoints.last) say(pipeline, work, "goes on from " + file.string());
    if (!why.empty()) say(pipeline, work, "begins again: the checkpoint " + why);
    checkpoints.keep = [&](const FramePart& part) {
        try {
            write_part(file, part, provenance_of(pipeline.scene, request, pipeline.plan, work.view, work.hash, {}),
                       request.grouping);
        } catch (const Error& error) {
            say(pipeline, work, std::string("goes on without a checkpoint: ") + error.what());
        }
    };
    const PartRange range = range_of(request.grouping, mode, work.view);
    work.part = render_part(mode, work.view, work.snapshot, pipeline.plan.settings, options, range,
                            std::move(checkpoints), work.report.stats);
}

void render(Pipeline& pipeline, Work& work) {
    const RenderRequest& request = pipeline.request;
    const RenderPlan& plan = pipeline.plan;
    const double start = steady_seconds();
    FrameOptions options{wants_layer(request, "halves"), nullptr, &pipeline.cancel, {}, {}};
    options.progress = [&](double share) { pipeline.progress.set(pipeline.settled + share); };
    FrameStats& stats = work.report.stats;
    try {
        History history;
        if (request.history > 0) warm_up(pipeline, work, history), options.history = &history;
        const Goal goal{request.target_error,
                        seconds_left(pipeline, work.view),
                        request.quality,
                        {},
                        work.index == 0 ? plan.choice : nullptr,
                        plan.wanted,
                        work.index == 0 ? plan.orders : std::nullopt};
        options.forecast = [&](double seconds) { say_forecast(pipeline, work, seconds); };
        if (is_part(request.grouping))
            render_own_part(pipeline, options, work);
        else if (has_goal(request))
            work.layers = render_to_target(*plan.mode, work.view, work.snapshot, plan.settings, goal, options, stats);
        else
            work.layers = render_frame(*plan.mode, work.view, work.snapshot, plan.settings, options, stats);
        if (!is_part(request.grouping))
            judge_planned(request.grouping.error, *plan.mode, work.view, work.snapshot, plan.settings, work.layers,
                          options, stats);
        if (missed_by_plan(plan, request, stats)) render_by_main_mode(pipeline, work, options);
        if (request.files) check_unchanged(*request.files);
    } catch (const Error& error) {
        fail_in_frame(work.report.frame, error);
    }
    ++pipeline.settled, ++pipeline.rendered;
    work.report.seconds = steady_seconds() - start;
}

// What is known of the error, its parts and what was asked for.
std::string error_text(const FrameStats& stats, const RenderRequest& request) {
    if (!stats.noise) return {};
    std::string text = stats.integrator || stats.orders ? ", error " : ", noise ";
    text += formatted("%.3g, at most %.3g", stats.error()->error, stats.error()->bound);
    if (request.target_error > 0) text += formatted(" (wanted %.3g)", request.target_error);
    if (stats.integrator)
        text += formatted(": noise %.3g, integrator %.3g (%s)", stats.noise->error, stats.integrator->error.error,
                          stats.integrator->candidate.c_str());
    if (stats.orders) text += formatted(", multiple scattering %.3g", stats.orders->tiles.error);
    text += formatted(stats.samples == 1 ? ", %d sample per pixel" : ", %d samples per pixel", stats.samples);
    if (request.time_budget > 0)
        text += formatted(", %.3g s of a budget of %.3g s", stats.goal_seconds, request.time_budget);
    return text;
}

void write(Pipeline& pipeline, Work& work) {
    const RenderRequest& request = pipeline.request;
    const double start = steady_seconds();
    FrameReport& report = work.report;
    try {
        const Provenance provenance = provenance_of(pipeline.scene, request, work.by ? *work.by : pipeline.plan,
                                                    work.view, work.hash, report.stats);
        if (is_part(request.grouping)) {
            write_part(report.file, work.part, provenance, request.grouping);
            std::error_code ignored; // it may never have been written
            std::filesystem::remove(checkpoint_name(report.file), ignored);
        } else {
            write_exr(report.file, work.layers, provenance, request.exr);
        }
        if (request.png) write_picture(pipeline, stored_color(work.layers, request.exr), report);
    } catch (const Error& error) {
        fail_in_frame(report.frame, error);
    }
    report.write_seconds = steady_seconds() - start;
    report_frame(pipeline, work);

    std::string text = formatted("%.2f s -> ", report.seconds) + report.file + error_text(report.stats, request);
    if (report.stats.non_finite) text += " (" + std::to_string(report.stats.non_finite) + " samples not finite)";
    say(pipeline, work, text);
}

// Runs `body` and keeps what it throws for later, so that the stage beside it can end in peace.
template<class Body> std::exception_ptr caught(const Body& body) {
    try {
        body();
    } catch (const std::exception&) {
        return std::current_exception();
    }
    return {};
}

void run(Pipeline& pipeline) {
    std::optional<Work> current = load_next(pipeline, nullptr), rendered;
    while (current) {
        std::optional<Work> next;
        std::exception_ptr render_error, write_error, load_error;
        run_together({[&] { render_error = caught([&] { render(pipeline, *current); }); },
                      [&] { load_error = caught([&] { next = load_next(pipeline, &current->snapshot); }); },
                      [&] {
                          if (rendered) write_error = caught([&] { write(pipeline, *rendered); });
                      }});
        if (write_error) std::rethrow_exception(write_error);
        if (render_error && pipeline.cancel) return;
        if (render_error) std::rethrow_exception(render_error);

        // The fog and triangles of a finished frame are not needed any more, unless the next one shares them.
        current->snapshot = {};
        rendered = std::move(current);
        current = std::move(next);
        if (load_error) {
            write(pipeline, *rendered);
            std::rethrow_exception(load_error);
        }
    }
    if (rendered) write(pipeline, *rendered);
}

// Over the budgets of all frames, where that is more than a hitch or there was no time for a second ray per pixel.
double seconds_late(const RenderRequest& request, const RenderReport& report) {
    const double all = request.time_budget * static_cast<double>(request.frames.size());
    const double late = all > 0 ? steady_seconds() - request.started - all : 0;
    const bool least = std::ranges::any_of(
        report.frames, [](const FrameReport& frame) { return !frame.kept && frame.stats.samples <= 1; });
    return late > (least ? 0 : std::max(0.1 * all, 0.2)) ? late : 0;
}

uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}
}

LoadedFrame load_first_frame(const Scene& scene, const RenderRequest& request, const Snapshot* previous) {
    const double start = steady_seconds();
    flush_denormals();
    auto files = request.files ? request.files->inputs : std::make_shared<FileHashes>();
    hash_fog(scene, request, request.frames[0], *files);
    Snapshot snapshot =
        make_snapshot(scene, moment_of(scene, request.frames[0]), previous, request.missing, request.files);
    return {std::move(snapshot), steady_seconds() - start, std::move(files)};
}

RenderReport render_sequence(const Scene& scene, const RenderRequest& request, const RenderPlan& asked,
                             Progress& progress, std::atomic<bool>& cancel, LoadedFrame* first) {
    const double start = steady_seconds();
    check_job(scene, request, *asked.mode);
    flush_denormals();
    RenderPlan plan = asked;
    if (request.png && !plan.exposure && measures_exposure(scene, request))
        plan.exposure = automatic_exposure(scene, request, orders_of(*asked.mode, request.settings),
                                           first ? &first->snapshot : nullptr);

    std::vector<std::string> lights;
    for (const LightSource& light : scene.lights) lights.push_back(light.name);
    Pipeline pipeline{scene,
                      request,
                      plan,
                      progress,
                      cancel,
                      channel_names(lights, request.exr),
                      first ? std::move(*first) : LoadedFrame{}};
    run(pipeline);

    RenderReport& report = pipeline.report;
    std::ranges::sort(report.frames, {}, [&](const FrameReport& frame) {
        return std::ranges::find(request.frames, frame.frame) - request.frames.begin();
    });
    for (const FrameReport& frame : report.frames)
        report.missed +=
            request.target_error > 0 && frame.stats.noise && frame.stats.error()->bound > request.target_error;
    report.late = seconds_late(request, report);
    report.cancelled = cancel && report.frames.size() < request.frames.size();
    report.seconds = steady_seconds() - start;
    report.peak_memory_bytes = peak_memory();
    return std::move(report);
}
}

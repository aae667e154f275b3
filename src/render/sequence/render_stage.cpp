// The rendering stage: a frame, or the requested part of it, with a number of samples or to a target error or time.
#include "base/clock.h"
#include "base/error.h"
#include "base/io/cache_folder.h"
#include "base/text.h"
#include "modes/history.h"
#include "modes/mode.h"
#include "render/adaptive/planned.h"
#include "render/adaptive/to_target.h"
#include "render/parts/part_file.h"
#include "render/sequence/pipeline.h"
#include "render/sequence/provenance.h"
#include "scene/scene.h"
#include "trace/moment.h"

#include <algorithm>

namespace tyndall {
namespace {
// Predicted seconds to write a frame.
double seconds_to_write(const RenderRequest& request, const View& view) {
    const double pixels = static_cast<double>(view.size.x) * view.size.y;
    return 0.01 + pixels * (request.png ? 1e-6 : 5e-7);
}

// Seconds for this frame; 0 if there is no limit. The frames ahead share alike what earlier ones left over or took too
// much, so that their noise does not alternate; with --resume any of them may be kept, and this frame takes it alone.
// Finished frames that it skips add the time they took.
double seconds_left(const Pipeline& pipeline, const FrameJob& work) {
    const RenderRequest& request = pipeline.request;
    if (request.time_budget == 0) return 0;
    const double ahead = request.resume ? 1 : static_cast<double>(request.frames.size() - work.index);
    const double end = request.started + request.time_budget * (pipeline.rendered + ahead) + pipeline.skipped_seconds;
    constexpr double safe = 0.96; // margin for delays of the process
    return std::max(safe * (end - steady_seconds() - seconds_to_write(request, work.view)) / ahead, 1e-3);
}

// Runs the mode on the frames before this one, so that a frame depends only on the scene and its number. Before the
// scene's first frame, time stands still. Each frame shares data with the one before; the first shares what the
// sequence's previous frame kept.
void warm_up(const Pipeline& pipeline, FrameJob& work, History& history) {
    const int frame = work.report.frame;
    Snapshot previous = work.snapshot;
    previous.cache = work.snapshot.previous_cache;
    for (int back = pipeline.request.history; back > 0 && !pipeline.cancel; --back) {
        const int earlier = frame_before(pipeline.scene, frame, back);
        Snapshot snapshot =
            make_snapshot(pipeline.scene, moment_of(pipeline.scene, earlier), &previous, pipeline.request.missing);
        View view = view_of(pipeline.scene, pipeline.request, pipeline.plan.settings, earlier);
        view.frame = frame - back;
        pipeline.plan.mode->prepare(view, snapshot, pipeline.plan.settings, &history);
        previous = std::move(snapshot);
    }
    work.snapshot.previous_cache = previous.cache;
}

// Reports the predicted time of a frame, if it is long.
void say_forecast(const Pipeline& pipeline, const FrameJob& work, double seconds) {
    constexpr double long_work = 10;
    if (seconds < long_work) return;
    if (seconds == infinity) return say(pipeline, work, "cannot reach the target error: it may be too small");
    say(pipeline, work, "will take about " + seconds_text(seconds));
}

// Loads the frame again with more moments. The first snapshot stays, as the next frame is loaded beside it.
void add_moments(const Pipeline& pipeline, FrameJob& work, int count) {
    RenderRequest request = pipeline.request;
    request.time_samples = count;
    const int frame = work.report.frame;
    say(pipeline, work, "needs " + std::to_string(count) + " time samples for the target error");
    work.finer = make_snapshot(pipeline.scene, moments_of(pipeline.scene, request, frame), &work.snapshot,
                               request.missing, request.files);
    work.view = view_of(pipeline.scene, request, pipeline.plan.settings, frame);
}

// Renders to the goal, with more moments than the frame was loaded with if these are too few for the target error.
void render_to_goal(const Pipeline& pipeline, FrameJob& work, const Mode& mode, const Settings& settings, Goal goal,
                    const FrameOptions& options) {
    FrameStats& stats = work.report.stats;
    FrameStats lost;
    goal.moment_limit = moment_limit(pipeline.scene, pipeline.request, work.report.frame);
    while (true) {
        if (work.finer) goal.choice = nullptr; // prepared for the first snapshot
        const Snapshot& snapshot = work.finer ? *work.finer : work.snapshot;
        work.layers = render_to_target(mode, work.view, snapshot, settings, goal, options, stats);
        if (stats.wanted_moments == 0) break;
        lost.add(stats), lost.goal_seconds += stats.goal_seconds;
        const double start = steady_seconds();
        add_moments(pipeline, work, stats.wanted_moments);
        lost.goal_seconds += steady_seconds() - start;
    }
    stats.add(lost), stats.goal_seconds += lost.goal_seconds;
    if (stats.forecast_seconds > 0) stats.forecast_seconds += lost.goal_seconds;
}

// Whether a technique chosen for the first frame missed the target.
bool missed_by_plan(const RenderPlan& plan, const RenderRequest& request, const FrameStats& stats) {
    return plan.wanted && plan.mode != &main_mode() && request.time_budget == 0 && stats.integrator &&
           stats.error()->bound > request.target_error;
}

void render_by_main_mode(Pipeline& pipeline, FrameJob& work, FrameOptions options) {
    const RenderPlan& plan = pipeline.plan;
    say(pipeline, work,
        std::string(plan.mode->name) + " misses the target error; rendering again with " +
            std::string(main_mode().name));
    work.report.mode = main_mode().name;
    work.by = RenderPlan{&main_mode(), *plan.wanted, plan.certificate, nullptr, plan.wanted};
    work.by->missed = plan.mode;
    Goal goal{pipeline.request.target_error, 0, pipeline.request.quality};
    if (work.index == 0) goal.choice = plan.main;
    options.history = nullptr;
    FrameStats& stats = work.report.stats;
    const FrameStats missed = stats;
    render_to_goal(pipeline, work, main_mode(), work.by->settings, goal, options);
    stats.add_lost(missed);
}

// Renders the requested part of the frame's samples, continuing from its last checkpoint.
void render_own_part(const Pipeline& pipeline, const FrameOptions& options, FrameJob& work) {
    const RenderRequest& request = pipeline.request;
    const Mode& mode = *pipeline.plan.mode;
    const std::filesystem::path file = checkpoint_name(work.report.file);
    std::string why;
    Checkpoints checkpoints{request.checkpoint_seconds};
    if (request.resume) checkpoints.last = read_checkpoint(file, work.hash, request.grouping, why);
    if (checkpoints.last) say(pipeline, work, "resumes from " + file.string());
    if (!why.empty()) say(pipeline, work, "starts over: the checkpoint file " + why);
    checkpoints.keep = [&](const FramePart& part) {
        try {
            write_part(file, part, provenance_of(pipeline.scene, request, pipeline.plan, work.view, work.hash, {}),
                       request.grouping);
        } catch (const Error& error) {
            say(pipeline, work, std::string("continues without a checkpoint: ") + error.what());
        }
    };
    const PartRange range = range_of(request.grouping, mode, work.view);
    work.part = render_part(mode, work.view, work.snapshot, pipeline.plan.settings, options, range,
                            std::move(checkpoints), work.report.stats);
}
}

void render(Pipeline& pipeline, FrameJob& work) {
    const RenderRequest& request = pipeline.request;
    const RenderPlan& plan = pipeline.plan;
    const double start = steady_seconds();
    FrameOptions options{wants_layer(request, "halves"), nullptr, &pipeline.cancel, {}, {}};
    options.progress = [&](double share) { pipeline.progress.set(pipeline.rendered + share); };
    FrameStats& stats = work.report.stats;
    try {
        History history;
        if (request.history > 0) warm_up(pipeline, work, history), options.history = &history;
        const Goal goal{request.target_error,
                        seconds_left(pipeline, work),
                        request.quality,
                        {},
                        work.index == 0 ? plan.choice : nullptr,
                        plan.wanted,
                        work.index == 0 ? plan.orders : std::nullopt,
                        plan.main ? plan.main->work_to(request.target_error) : infinity,
                        plan.main_seconds};
        options.forecast = [&](double seconds) { say_forecast(pipeline, work, seconds); };
        if (is_part(request.grouping))
            render_own_part(pipeline, options, work);
        else if (has_goal(request))
            render_to_goal(pipeline, work, *plan.mode, plan.settings, goal, options);
        else
            work.layers = render_frame(*plan.mode, work.view, work.snapshot, plan.settings, options, stats);
        if (!is_part(request.grouping))
            add_planned_error(request.grouping.error, *plan.mode, work.view, work.snapshot, plan.settings, work.layers,
                              options, stats);
        if (missed_by_plan(plan, request, stats)) render_by_main_mode(pipeline, work, options);
        if (request.files) check_unchanged(*request.files);
    } catch (const Error& error) {
        fail_in_frame(work.report.frame, error);
    }
    ++pipeline.rendered;
    work.report.seconds += steady_seconds() - start;
}
}

// The pipeline over frames: one is rendered while the one before is written and the one after is loaded.
#include "render/sequence/sequence.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/io/cache_folder.h"
#include "base/io/output.h"
#include "base/parallel.h"
#include "base/process.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/image/png.h"
#include "render/parts/part_file.h"
#include "render/sequence/auto_exposure.h"
#include "render/sequence/pipeline.h"
#include "render/sequence/provenance.h"
#include "scene/scene.h"
#include "trace/moment.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace tyndall {
void write_frame_png(const Pipeline& pipeline, const Image<vec3>& color, FrameReport& report) {
    const Display display = display_of(pipeline.scene, pipeline.request, pipeline.plan, report.frame);
    write_png(png_name(report.file), color, display);
    report.exposure = display.exposure;
}

void fail_in_frame(int frame, const Error& error) {
    const std::string text = error.what(), name = "frame " + std::to_string(frame);
    const size_t split = text.rfind(": ", 200);
    if (split == text.npos) fail(error.code, name, text);
    fail(error.code, name + ": " + text.substr(0, split), text.substr(split + 2));
}

void say(const Pipeline& pipeline, const FrameJob& work, const std::string& what) {
    pipeline.progress.line("frame " + std::to_string(work.report.frame) + " (" + std::to_string(work.index + 1) + "/" +
                           std::to_string(pipeline.request.frames.size()) + ") " + what);
}

void report_frame(Pipeline& pipeline, const FrameJob& work) {
    const std::scoped_lock lock(pipeline.reporting);
    pipeline.report.non_finite += work.report.stats.non_finite;
    pipeline.report.frames.push_back(work.report);
}

namespace {
// The error, its parts, the target and the budget, as text.
std::string error_text(const FrameReport& report, const RenderRequest& request) {
    const FrameStats& stats = report.stats;
    if (!stats.noise) return {};
    std::string text = stats.is_noise_alone() ? ", noise " : ", error ";
    text += formatted("%.3g, at most %.3g", stats.error()->error, stats.error()->bound);
    if (request.target_error > 0) text += formatted(" (target %.3g)", request.target_error);
    if (stats.integrator)
        text += formatted(": noise %.3g, integrator %.3g (%s)", stats.noise->error, stats.integrator->error.error,
                          stats.integrator->candidate.c_str());
    if (stats.orders) text += formatted(", multiple scattering %.3g", stats.orders->pixels.error);
    if (stats.moments_error) text += formatted(", moments %.3g", stats.moments_error->error);
    text += formatted(stats.samples == 1 ? ", %d sample per pixel" : ", %d samples per pixel", stats.samples);
    if (request.time_budget > 0)
        text += formatted(", %.3g s of a budget of %.3g s", report.seconds, request.time_budget);
    return text;
}

void write(Pipeline& pipeline, FrameJob& work) {
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
        if (request.png) write_frame_png(pipeline, stored_color(work.layers, request.exr), report);
    } catch (const Error& error) {
        fail_in_frame(report.frame, error);
    }
    report.write_seconds = steady_seconds() - start;
    report_frame(pipeline, work);

    std::string text = formatted("%.2f s -> ", report.seconds) + report.file + error_text(report, request);
    if (report.stats.moments > 1) text += formatted(", motion blur of %d moments", report.stats.moments);
    if (report.stats.non_finite) text += " (" + std::to_string(report.stats.non_finite) + " non-finite samples)";
    say(pipeline, work, text);
}

// Runs `body` and returns what it throws, so that the stages beside it can finish.
template<class Body> std::exception_ptr caught(const Body& body) {
    try {
        body();
    } catch (const std::exception&) {
        return std::current_exception();
    }
    return {};
}

void run(Pipeline& pipeline) {
    const RenderRequest& request = pipeline.request;
    std::optional<FrameJob> current = load_next(pipeline, nullptr), rendered;
    if (current) // a budget includes all that was done since the program's start
        current->report.seconds =
            request.time_budget > 0 ? steady_seconds() - request.started : current->report.load_seconds;
    while (current) {
        std::optional<FrameJob> next;
        std::exception_ptr render_error, write_error, load_error;
        const double start = steady_seconds();
        double end = start;
        parallel_invoke({[&] {
                             current->report.seconds += steady_seconds() - start;
                             render_error = caught([&] { render(pipeline, *current); });
                             end = steady_seconds();
                         },
                         [&] { load_error = caught([&] { next = load_next(pipeline, &current->snapshot); }); },
                         [&] {
                             if (rendered) write_error = caught([&] { write(pipeline, *rendered); });
                         }});
        if (write_error) std::rethrow_exception(write_error);
        if (render_error && pipeline.cancel) return;
        if (render_error) std::rethrow_exception(render_error);

        // Releases the fog and triangles of the finished frame, unless the next one shares them.
        current->snapshot = {}, current->finer.reset();
        rendered = std::move(current);
        current = std::move(next);
        if (current) current->report.seconds = steady_seconds() - end;
        if (load_error) {
            write(pipeline, *rendered);
            std::rethrow_exception(load_error);
        }
    }
    if (rendered) write(pipeline, *rendered);
}

// Seconds over the budgets of all frames rendered; 0 for a slight delay, unless there was no time for a second ray per
// pixel.
double seconds_late(const RenderRequest& request, const RenderReport& report, double skipped_seconds) {
    const auto kept = std::ranges::count(report.frames, true, &FrameReport::kept);
    const double all = request.time_budget * static_cast<double>(std::ssize(request.frames) - kept);
    const double late = all > 0 ? steady_seconds() - request.started - skipped_seconds - all : 0;
    const bool least = std::ranges::any_of(
        report.frames, [](const FrameReport& frame) { return !frame.kept && frame.stats.samples <= 1; });
    return late > (least ? 0 : std::max(0.1 * all, 0.2)) ? late : 0;
}
}

LoadedFrame load_first_frame(const Scene& scene, const RenderRequest& request, const Snapshot* previous) {
    const double start = steady_seconds();
    flush_denormals();
    auto files = request.files ? request.files->inputs : std::make_shared<FileHashes>();
    hash_fog(scene, request, request.frames[0], *files);
    Snapshot snapshot =
        make_snapshot(scene, moments_of(scene, request, request.frames[0]), previous, request.missing, request.files);
    return {std::move(snapshot), steady_seconds() - start, std::move(files)};
}

RenderReport render_sequence(const Scene& scene, const RenderRequest& request, const RenderPlan& asked,
                             Progress& progress, std::atomic<bool>& cancel, LoadedFrame* first) {
    const double start = steady_seconds();
    OutputPaths places;
    check_job(scene, request, *asked.mode, places);
    flush_denormals();
    RenderPlan plan = asked;
    if (request.png && !plan.exposure && needs_auto_exposure(scene, request))
        plan.exposure = automatic_exposure(scene, request, orders_of(*asked.mode, request.settings),
                                           first ? &first->snapshot : nullptr);

    const double loading = first ? first->seconds : 0;
    std::vector<std::string> lights;
    for (const LightSource& light : scene.lights) lights.push_back(light.name);
    Pipeline pipeline{scene,
                      request,
                      plan,
                      progress,
                      cancel,
                      channel_names(lights, has_colored_fog(scene), request.exr),
                      first ? std::move(*first) : LoadedFrame{}};
    run(pipeline);

    RenderReport& report = pipeline.report;
    std::ranges::sort(report.frames, {}, [&](const FrameReport& frame) {
        return std::ranges::find(request.frames, frame.frame) - request.frames.begin();
    });
    for (const FrameReport& frame : report.frames)
        report.missed +=
            request.target_error > 0 && frame.stats.noise && frame.stats.error()->bound > request.target_error;
    report.late = seconds_late(request, report, pipeline.skipped_seconds);
    report.cancelled = cancel && report.frames.size() < request.frames.size();
    report.seconds = steady_seconds() - start, report.loading = loading;
    report.peak_memory_bytes = peak_memory();
    return std::move(report);
}
}

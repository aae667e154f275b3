#include "measure/chart/point.h"

#include "base/clock.h"
#include "measure/metrics/heatmap.h"
#include "measure/verify/memory_growth.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "render/frame/layers.h"
#include "render/sequence/job.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <algorithm>
#include <ctime>

namespace tyndall {
namespace {
constexpr double shortest_measurement = 0.25; // seconds that runs last together, up to max_runs
constexpr int max_runs = 5;

double median(std::vector<double> values) {
    std::ranges::sort(values);
    const size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

// The snapshot that the mode is measured on, with nothing cached.
Snapshot seen_by(const Mode& mode, const Snapshot& snapshot) {
    Snapshot result = fresh(snapshot);
    if (lights_only(mode)) result.background = {};
    return result;
}

View view_for(const ChartStage& stage, const Settings& settings, ivec2 size, int frame) {
    RenderRequest request = stage.job.render;
    request.resolution = size;
    return view_of(stage.scene, request, settings, frame);
}

// Processor time of all threads of the process.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Times {
    std::vector<double> cold, warm, render; // preparing the first frame and the next, rendering
    std::vector<double> processor;          // the first frame
    double memory = not_measured;
};

// Renders the image and prepares the next frame, once each.
Layers timed_run(const ChartStage& stage, const Mode& mode, const Settings& settings,
                 const std::function<void(double)>& progress, Times& times, double& non_finite) {
    const ivec2 size = stage.job.render.resolution;
    const View view = view_for(stage, settings, size, stage.job.frame);
    const Snapshot now = seen_by(mode, stage.snapshot);
    FrameOptions options;
    options.cancel = stage.cancel, options.progress = progress;
    FrameStats stats;
    const MemoryGrowth memory;
    const double before = processor_seconds();
    Layers layers = render_frame(mode, view, now, settings, options, stats);
    times.processor.push_back(processor_seconds() - before);
    if (const std::optional<double> bytes = memory.peak()) times.memory = std::fmax(times.memory, *bytes);
    times.cold.push_back(stats.prepare_seconds), times.render.push_back(stats.render_seconds);
    non_finite = static_cast<double>(stats.non_finite);

    Snapshot next = seen_by(mode, stage.next);
    next.previous_cache = now.cache;
    const View next_view = view_for(stage, settings, size, stage.next_frame);
    const double start = steady_seconds();
    const Prepared prepared = prepare_frame(mode, next_view, next, settings, nullptr);
    times.warm.push_back(steady_seconds() - start);
    return layers;
}

void take_times(const Times& times, ChartPoint& point) {
    const double next = median(times.warm);
    std::vector<double> frames;
    for (const double seconds : times.render) frames.push_back(next + seconds);
    point.runs = static_cast<double>(frames.size());
    point.setup_seconds = std::max(median(times.cold) - next, 0.0);
    point.frame_seconds = median(frames);
    point.frame_fastest = *std::ranges::min_element(frames), point.frame_slowest = *std::ranges::max_element(frames);
    point.seconds_1 = point.frame_seconds + point.setup_seconds;
    point.seconds_100 = point.frame_seconds + point.setup_seconds / 100;
    point.cpu_seconds = median(times.processor);
    point.memory_bytes = times.memory;
}

// Measures the technique's own error at pixel centers, where edges and lamps inside pixels do not matter.
void measure_centers(const ChartStage& stage, const Mode& mode, Settings settings, ChartPoint& point) {
    settings.pixel.filter = PixelFilter::center;
    const View view = view_for(stage, settings, stage.job.render.resolution, stage.job.frame);
    FrameOptions options;
    options.cancel = stage.cancel;
    FrameStats stats;
    Layers layers = render_frame(mode, view, seen_by(mode, stage.snapshot), settings, options, stats);
    const ColorLayers picture{std::move(layers.color), std::move(layers.inscatter)};
    const ReferenceMetrics& reference_metrics = lights_only(mode) ? stage.centers_lights : stage.centers_all;
    const ChartErrors errors = chart_errors(reference_metrics, picture);
    point.fog_error = errors.inscatter_rmse, point.fog_uncertainty = errors.inscatter_uncertainty;
    if (is_artistic(point))
        point.fitted_fog_error =
            chart_errors(reference_metrics, with_gain(picture, fitted_gain(reference_metrics, picture))).inscatter_rmse;
}

double flicker(const ChartStage& stage, const Mode& mode, Settings settings) {
    settings.pixel.filter = PixelFilter::center;
    std::vector<ColorLayers> pictures;
    for (const SequenceFrame& frame : stage.sequence) {
        View view = view_for(stage, settings, stage.sequence_size, frame.frame);
        view.frame = frame.pattern;
        FrameOptions options;
        options.cancel = stage.cancel;
        FrameStats stats;
        Layers layers = render_frame(mode, view, seen_by(mode, frame.snapshot), settings, options, stats);
        pictures.push_back({std::move(layers.color), std::move(layers.inscatter)});
    }
    return chart_flicker(lights_only(mode) ? stage.sequence_lights : stage.sequence_all, pictures);
}
}

std::vector<ChartRung> rungs_of(const ChartJob& job) {
    std::vector<ChartRung> rungs;
    for (const Mode* mode : job.modes) {
        const std::vector<Candidate> ladder = ladder_of(*mode, job.render.settings);
        for (size_t i = 0; i < ladder.size(); ++i) rungs.push_back({mode, ladder[i], static_cast<int>(i) + 1});
    }
    return rungs;
}

bool lights_only(const Mode& mode) { return mode.accuracy == Accuracy::multiple_scattering; }

Settings settings_of(const ChartRung& rung) {
    Settings settings = rung.candidate.settings;
    if (lights_only(*rung.mode)) settings.path.orders = 1, settings.terms.ambient = settings.terms.emission = false;
    return settings;
}

std::string rows_of(const Settings& settings) {
    const Settings usual = settings_for(Quality::preview);
    std::string text;
    for (const SettingRow& row : setting_rows())
        if (row.get(settings) != row.get(usual) || row.name == "pixel.samples")
            text += (text.empty() ? "" : " ") + row.name + "=" + row.get(settings);
    return text;
}

double expected_seconds(const ChartStage& stage, const ChartRung& rung) {
    Settings settings = settings_of(rung);
    const int samples = settings.pixel.samples;
    settings.pixel.samples = std::min(samples, 4); // from four on, pixels with edges take more rays
    const ivec2 size = stage.job.render.resolution, small = glm::max(size / 2, ivec2(1));
    FrameOptions options;
    options.cancel = stage.cancel;
    FrameStats stats;
    const Snapshot now = seen_by(*rung.mode, stage.snapshot);
    render_frame(*rung.mode, view_for(stage, settings, small, stage.job.frame), now, settings, options, stats);
    Snapshot next = seen_by(*rung.mode, stage.next);
    prepare_frame(*rung.mode, view_for(stage, settings, small, stage.next_frame), next, settings, nullptr);
    const double larger = static_cast<double>(size.x) * size.y / (static_cast<double>(small.x) * small.y);
    return stats.prepare_seconds + stats.render_seconds * larger * samples / settings.pixel.samples;
}

MeasuredPoint measure_point(const ChartStage& stage, const ChartRung& rung,
                            const std::function<void(double)>& progress) {
    const Mode& mode = *rung.mode;
    const Settings settings = settings_of(rung);
    MeasuredPoint result;
    ChartPoint& point = result.point;
    point.mode = mode.name, point.settings = rows_of(settings);
    point.rung = rung.place, point.samples = settings.pixel.samples;

    Times times;
    ColorLayers picture;
    const double start = steady_seconds();
    for (int run = 0; run < stage.job.runs || (run < max_runs && steady_seconds() - start < shortest_measurement);
         ++run) {
        const auto part = [&](double done) { progress((std::min(run, stage.job.runs - 1) + done) / stage.job.runs); };
        Layers layers = timed_run(stage, mode, settings, part, times, point.non_finite);
        picture = {std::move(layers.color), std::move(layers.inscatter)};
    }
    take_times(times, point);
    measure_centers(stage, mode, settings, point);
    point.flicker = flicker(stage, mode, settings);

    const ReferenceMetrics& reference_metrics = lights_only(mode) ? stage.lights : stage.all;
    point.errors = chart_errors(reference_metrics, picture);
    if (is_artistic(point)) {
        point.gain = fitted_gain(reference_metrics, picture);
        point.fitted = chart_errors(reference_metrics, with_gain(picture, point.gain));
    }
    result.picture = whole(reference_metrics, picture.color);
    result.errors = error_map(result.picture, reference_metrics.shown_mean.color, reference_metrics.mean);
    return result;
}
}

#include "base/clock.h"
#include "measure/chart/earlier_points.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/parallel.h"
#include "base/simd/isa.h"
#include "base/text.h"
#include "measure/chart/chart.h"
#include "measure/chart/point.h"
#include "modes/mode.h"
#include "render/sequence/auto_exposure.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>
#include <cstdlib>

namespace tyndall {
namespace {
constexpr int fewest_pixels = 16; // across a frame of the sequence

double load_average() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? load : not_measured;
}

// Frames around the chart's own; if the scene has too few, the same frame with other noise.
std::vector<SequenceFrame> make_sequence(const Scene& scene, const ChartJob& job, const Snapshot& snapshot) {
    const int last = scene.last_frame - job.sequence + 1;
    const bool moves = job.sequence > 1 && last >= scene.first_frame;
    std::vector<SequenceFrame> frames;
    for (int i = 0; i < job.sequence; ++i) {
        const int frame = moves ? std::clamp(job.frame, scene.first_frame, last) + i : job.frame;
        const Snapshot& previous = i ? frames.back().snapshot : snapshot;
        Snapshot now = make_snapshot(scene, moment_of(scene, frame), &previous, job.render.missing);
        frames.push_back({std::move(now), frame, moves ? frame : frame + i});
    }
    return frames;
}

ChartStage make_stage(const Scene& scene, const ChartJob& job, std::atomic<bool>* cancel) {
    ChartStage stage{scene, job, {}, {}, 0, {}, ivec2(0), {}, {}, {}, {}, {}, {}, cancel};
    stage.snapshot = make_snapshot(scene, moment_of(scene, job.frame), nullptr, job.render.missing);
    stage.next_frame = job.frame < scene.last_frame ? job.frame + 1 : job.frame;
    stage.next = make_snapshot(scene, moment_of(scene, stage.next_frame), &stage.snapshot, job.render.missing);
    stage.sequence = make_sequence(scene, job, stage.snapshot);
    stage.sequence_size = glm::max(job.render.resolution / job.smaller, ivec2(fewest_pixels));
    return stage;
}

// Share of the progress bar for estimating how long the work will take.
constexpr double share_of_planning = 0.05;

// Progress over the parts of the work, weighted by the seconds they are expected to take.
class ChartProgress {
public:
    explicit ChartProgress(const ChartControl& control) : control_(control) {}
    void expect(double seconds) { total_ += seconds; }
    void show(double share_of_part, double seconds_of_part) const {
        if (!control_.progress || total_ == 0) return;
        const double done = (done_ + share_of_part * seconds_of_part) / total_;
        control_.progress(share_of_planning + (1 - share_of_planning) * done);
    }
    void finish(double seconds_of_part) { done_ += seconds_of_part, show(0, 0); }

private:
    const ChartControl& control_;
    double total_ = 0, done_ = 0;
};

struct Task {
    ChartRung rung;
    std::string hash;
    std::optional<ChartPoint> kept;
    double seconds = 0; // expected for an image
};

// Seconds to measure a whole point; frames of the sequence are smaller.
double seconds_of(const Task& task, const ChartJob& job) {
    return task.seconds * (job.runs + 1 + static_cast<double>(job.sequence) / (job.smaller * job.smaller));
}

bool wants_unlit(const ChartJob& job) {
    return std::ranges::any_of(job.modes, [](const Mode* mode) { return lights_only(*mode); });
}
ReferenceSamples picture_samples(const ChartJob& job) {
    ReferenceSamples samples = job.reference;
    samples.unlit = wants_unlit(job);
    return samples;
}
ReferenceSamples center_samples(const ChartJob& job) {
    ReferenceSamples samples = picture_samples(job);
    samples.count = 4, samples.centers = true;
    return samples;
}

struct References {
    Shot picture;
    std::vector<Shot> sequence;
};

References references_of(const ChartStage& stage) {
    const ChartJob& job = stage.job;
    References result{
        {stage.scene, stage.snapshot, job.render, job.frame, job.directory / "reference", stage.cancel, {}}, {}};
    for (const SequenceFrame& frame : stage.sequence) {
        Shot shot{stage.scene, frame.snapshot, job.render, frame.frame, job.directory / "reference", stage.cancel, {}};
        shot.request.resolution = stage.sequence_size;
        result.sequence.push_back(shot);
    }
    return result;
}

std::string hash_of(const References& references, const ChartJob& job, FileHashes& files) {
    std::string text = reference_hash(references.picture, picture_samples(job), files) +
                       reference_hash(references.picture, center_samples(job), files);
    for (const Shot& shot : references.sequence) text += reference_hash(shot, center_samples(job), files);
    return content_hash(text);
}

void render_references(ChartStage& stage, References& references, Chart& chart, FileHashes& files,
                       const ChartProgress& progress, double seconds) {
    references.picture.progress = [&](double done) { progress.show(done, seconds); };
    const Reference reference = make_reference(references.picture, picture_samples(stage.job), files);
    const bool unlit = wants_unlit(stage.job);
    stage.all = make_metrics(reference, false);
    if (unlit) stage.lights = make_metrics(reference, true);
    references.picture.progress = {};
    const Reference centers = make_reference(references.picture, center_samples(stage.job), files);
    stage.centers_all = make_metrics(centers, false);
    if (unlit) stage.centers_lights = make_metrics(centers, true);
    for (const Shot& shot : references.sequence) {
        const bool again = !stage.sequence_all.empty() && shot.frame == references.sequence[0].frame;
        if (again) {
            stage.sequence_all.push_back(stage.sequence_all[0]);
            if (unlit) stage.sequence_lights.push_back(stage.sequence_lights[0]);
            continue;
        }
        const Reference frame = make_reference(shot, center_samples(stage.job), files);
        stage.sequence_all.push_back(make_metrics(frame, false));
        if (unlit) stage.sequence_lights.push_back(make_metrics(frame, true));
    }

    // Half the difference of the halves estimates the error of their mean.
    const Image<vec3>&a = reference.halves[0].color, &b = reference.halves[1].color;
    chart.reference_noise = relative(0.5 * measure_errors(a, b).rmse, stage.all.mean);
    chart.reference_flip = flip_mean(flip_hdr(a, b, stage.all.viewing.exposures, flip_pixels_per_degree));
}

// Drops modes that are compared by the light of lamps and suns alone when the scene has none.
ChartJob job_for(const Scene& scene, ChartJob job, const ChartControl& control) {
    if (!scene.lights.empty() || !wants_unlit(job)) return job;
    std::string skipped;
    for (const Mode* mode : job.modes)
        if (lights_only(*mode)) skipped += (skipped.empty() ? "" : ", ") + std::string(mode->name);
    const std::string why =
        "skipped: " + skipped + " would be compared by the light of lamps and suns, and the scene has none";
    std::erase_if(job.modes, [](const Mode* mode) { return lights_only(*mode); });
    if (job.modes.empty()) fail(ExitCode::usage, "--modes", why);
    if (control.remark) control.remark(why);
    return job;
}

std::vector<ChartedMode> charted_modes(const ChartStage& stage) {
    std::vector<ChartedMode> result;
    const ChartJob& job = stage.job;
    for (const Mode* mode : job.modes) {
        const View view = view_of(stage.scene, job.render, job.render.settings, job.frame);
        const Settings settings = settings_of({mode, {"", job.render.settings}, 0});
        result.push_back({std::string(mode->name), std::string(mode->summary), mode->accuracy,
                          mode->limitations(view, fresh(stage.snapshot), settings)});
    }
    return result;
}

std::string line_on(const ChartPoint& point) {
    return formatted("%-14s %3d rays per pixel  %8.4f s  error %.4f", point_name(point).c_str(),
                     static_cast<int>(point.samples), point.seconds_1, point.errors.error);
}

// Finds points to reuse, leaves out rungs that would take too long, and estimates the time of the rest. Rungs after one
// that is left out take longer still.
std::vector<Task> plan_tasks(const ChartStage& stage, const std::string& references, FileHashes& files, Chart& chart,
                             const ChartControl& control) {
    std::vector<Task> tasks;
    const std::vector<ChartRung> rungs = rungs_of(stage.job);
    for (const ChartRung& rung : rungs) {
        if (control.progress)
            control.progress(share_of_planning * static_cast<double>(&rung - rungs.data()) /
                             static_cast<double>(rungs.size()));
        Task task{rung, point_hash(stage, rung, references, files), {}, 0};
        task.kept = cached_point(stage.job.directory, rung, task.hash);
        const SkippedRung* before = chart.skipped.empty() ? nullptr : &chart.skipped.back();
        const bool goes_on = before && before->mode == rung.mode->name;
        if (!task.kept) task.seconds = goes_on ? before->seconds : expected_seconds(stage, rung);
        if (task.seconds <= stage.job.longest) {
            tasks.push_back(std::move(task));
            continue;
        }
        chart.skipped.push_back({std::string(rung.mode->name), rows_of(settings_of(rung)), rung.place, task.seconds});
        if (control.remark && !goes_on)
            control.remark(formatted("%s.%d and the settings after it are skipped: an image would take about %.2g s",
                                     std::string(rung.mode->name).c_str(), rung.place, task.seconds));
    }
    return tasks;
}
}

Chart make_chart(const Scene& scene, const ChartJob& asked, const ChartControl& control) {
    const double start = steady_seconds();
    flush_denormals();
    Chart chart;
    chart.job = job_for(scene, asked, control);
    const ChartJob& job = chart.job;
    chart.size = job.render.resolution, chart.threads = thread_count(), chart.isa = isa_name();
    chart.camera = camera_at(scene, find_camera(scene, job.render.camera), 0).name;
    chart.load_before = load_average();

    ChartStage stage = make_stage(scene, job, control.cancel);
    chart.sequence_size = stage.sequence_size;
    chart.moves = stage.sequence.size() > 1 && stage.sequence[0].frame != stage.sequence[1].frame;
    chart.modes = charted_modes(stage);
    FileHashes files;
    References references = references_of(stage);
    const std::string hash = hash_of(references, job, files);
    const std::vector<Task> tasks = plan_tasks(stage, hash, files, chart, control);

    ChartProgress progress(control);
    const bool work = std::ranges::any_of(tasks, [](const Task& task) { return !task.kept; });
    const double first = work ? reference_seconds(references.picture, picture_samples(job)) : 0;
    progress.expect(first);
    for (const Task& task : tasks) progress.expect(seconds_of(task, job));
    render_references(stage, references, chart, files, progress, first);
    progress.finish(first);

    RenderPlan shown;
    if (needs_auto_exposure(scene, job.render))
        shown.exposure = automatic_exposure(scene, job.render, 1, &stage.snapshot);
    const Display display = display_of(scene, job.render, shown, job.frame);
    for (const Task& task : tasks) {
        if (control.cancel && *control.cancel) fail(ExitCode::internal, "chart", "cancelled");
        const double seconds = seconds_of(task, job);
        if (task.kept) {
            chart.points.push_back(*task.kept), ++chart.kept;
        } else {
            const MeasuredPoint measured =
                measure_point(stage, task.rung, [&](double done) { progress.show(done, seconds); });
            keep_point(job.directory, measured, task.hash, display);
            chart.points.push_back(measured.point);
            if (control.remark) control.remark(line_on(measured.point));
        }
        progress.finish(seconds);
    }
    mark_best(chart.points);
    chart.load_after = load_average();
    chart.seconds = steady_seconds() - start;
    return chart;
}
}

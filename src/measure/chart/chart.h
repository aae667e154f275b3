// Every mode's error against its time, on one scene: each at several settings, all against one reference.
#pragma once
#include "measure/chart/errors.h"
#include "modes/mode.h"
#include "render/adaptive/candidates.h"

#include <cstdint>
#include <limits>

namespace tyndall {
inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
inline constexpr ChartErrors no_errors{not_measured, not_measured, not_measured, not_measured, not_measured,
                                       not_measured, not_measured, not_measured, not_measured};

// A mode at one rung of its ladder of settings. Times are wall-clock seconds, errors are relative to the reference's
// mean.
struct ChartPoint {
    std::string mode, settings; // settings: the rung's arguments of --set, separated by spaces
    double rung = 0, samples = 0, runs = 0;
    double setup_seconds = 0; // on top of a frame; shared by the frames that follow
    double frame_seconds = 0, frame_fastest = 0, frame_slowest = 0; // median of the runs; their range
    double seconds_1 = 0, seconds_100 = 0;                          // a frame with its share of the setup for 1 and 100
    double cpu_seconds = 0;             // of all threads together, for a frame and its setup
    double memory_bytes = not_measured; // peak on top of the scene
    ChartErrors errors;
    double fog_error = 0, fog_uncertainty = 0; // rmse of the fog light at pixel centers, independent of the rays per
                                               // pixel: the technique's own error
    double flicker = not_measured;
    double gain = not_measured;     // of artistic modes: the best-fitting factor on their fog light
    ChartErrors fitted = no_errors; // with that gain
    double fitted_fog_error = not_measured;
    double best_1 = 0, best_100 = 0, best_fog = 0; // 1: unbeaten() by E, for 1 and for 100 frames; by fog light, for 1
    double non_finite = 0;                         // samples left out
};

// The fields of a point by name, in the order of reports.
struct ChartField {
    std::string name, doc;
    double& (*of)(ChartPoint&);
};
const std::vector<ChartField>& chart_fields();
double value_of(const ChartField& field, const ChartPoint& point);

std::string point_name(const ChartPoint& point); // "march.3"
bool is_artistic(const ChartPoint& point);       // of an artistic mode; it has a gain

struct ChartJob {
    RenderRequest render; // scene file, camera, image size, settings that rungs do not change
    int frame = 1;
    std::vector<const Mode*> modes;
    ReferenceSamples reference{};
    int runs = 3;                    // of each image, at least
    double longest = 60;             // seconds an image may take; rungs that would take longer are left out
    int sequence = 4;                // frames that flicker is measured on
    int smaller = 4;                 // factor by which their width and height are smaller than the image's
    std::filesystem::path directory; // of points and references, reused by later runs
};

// A rung that was left out, and the least seconds its image would have taken.
struct SkippedRung {
    std::string mode, settings; // as in ChartPoint
    int rung = 0;
    double seconds = 0;
};

struct ChartedMode {
    std::string name, summary;
    Accuracy accuracy = Accuracy::artistic;
    Limitations limitations;
};

struct Chart {
    ChartJob job;
    std::string camera;
    ivec2 size{0}, sequence_size{0};
    int threads = 0;
    std::string isa;
    double load_before = 0, load_after = 0; // load average of the last minute
    bool moves = false;                     // the frames of the sequence differ
    double reference_noise = 0;             // of the mean of both halves, relative to its mean
    double reference_flip = 0;              // between the halves: FLIP of noise alone
    std::vector<ChartedMode> modes;
    std::vector<ChartPoint> points; // by mode, from fast to accurate
    std::vector<SkippedRung> skipped;
    int kept = 0; // points reused from an earlier run
    double seconds = 0;
};

// Whether other work was running, which makes times longer.
inline bool was_loaded(const Chart& chart) { return chart.load_before > chart.threads + 0.5; }

struct ChartControl {
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress;           // 0..1
    std::function<void(const std::string&)> remark; // a line for each point
};

// Writes each point to the job's directory as soon as it is measured, and reuses those there of the same scene,
// settings and number of threads. Throws Error.
Chart make_chart(const Scene& scene, const ChartJob& job, const ChartControl& control);

// A point's coordinates in a drawing: its time, and its error, but at least the uncertainty from the reference's noise.
enum class FrameTime { single, sequence };
enum class ErrorOf { worse, fog }; // image or fog light, whichever is worse (E); fog light at pixel centers
double seconds_of(const ChartPoint& point, FrameTime time);
double error_of(const ChartPoint& point, ErrorOf what);

// Whether a point is Pareto-optimal: no other is at least as fast and as accurate, and better in one of the two.
bool is_pareto(const ChartPoint& point, std::span<const ChartPoint> points, FrameTime time, ErrorOf what);
void mark_best(std::vector<ChartPoint>& points);

// A point's files, relative to the directory: its numbers, its image and error map, and thumbnails of both.
struct PointFiles {
    std::filesystem::path values, picture, errors, small_picture, small_errors;
};
PointFiles files_of(const ChartPoint& point);
}

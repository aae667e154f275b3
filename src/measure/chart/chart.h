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

// A mode at one of its settings. Times are wall-clock seconds, errors shares of the reference's mean.
struct ChartPoint {
    std::string mode, settings; // settings: rows for --set that make the rung, with spaces between
    double rung = 0, samples = 0, runs = 0;
    double setup_seconds = 0;                                       // on top of a frame: what frames that follow share
    double frame_seconds = 0, frame_fastest = 0, frame_slowest = 0; // median of the runs; their range
    double seconds_1 = 0, seconds_100 = 0; // a frame with its share of the set-up for 1 and 100
    double cpu_seconds = 0;                // of all threads together, for a frame and its set-up
    double memory_bytes = not_measured;    // most on top of the scene
    ChartErrors errors;
    double fog_error = 0, fog_uncertainty = 0; // rmse of the fog light at pixel centres, which rays per pixel do not
                                               // decide: what the technique itself is off by
    double flicker = not_measured;
    double gain = not_measured;     // of looks: the factor on their fog light that fits best
    ChartErrors fitted = no_errors; // with it
    double fitted_fog_error = not_measured;
    double best_1 = 0, best_100 = 0, best_fog = 0; // 1: unbeaten by E, for 1 and for 100 frames; by fog light, for 1
    double non_finite = 0;                         // samples left out
};

// The numbers of a point by name, in the order of reports.
struct ChartField {
    std::string name, doc;
    double& (*of)(ChartPoint&);
};
const std::vector<ChartField>& chart_fields();
double value_of(const ChartField& field, const ChartPoint& point);

std::string point_name(const ChartPoint& point); // "march.3"
bool is_look(const ChartPoint& point);           // a mode that promises no light; it has a gain

struct ChartJob {
    RenderRequest render; // scene file, camera, picture size, settings that rungs do not decide
    int frame = 1;
    std::vector<const Mode*> modes;
    ReferenceSamples reference{};
    int runs = 3;                    // of each picture, at least
    double longest = 60;             // seconds a picture may take; rungs that would take longer are left out
    int sequence = 4;                // frames that flicker is measured on
    int smaller = 4;                 // their width and height as a share of the picture's
    std::filesystem::path directory; // for what is kept
};

// A rung that was left out, and the seconds its picture would have taken: that many or more.
struct LeftOut {
    std::string mode, settings; // as of a point
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
    double load_before = 0, load_after = 0; // processes that wanted to run, a mean over the last minute
    bool moves = false;                     // the frames of the sequence differ
    double reference_noise = 0;             // of the mean of both halves, as a share of its mean
    double reference_flip = 0;              // between the halves: what FLIP says of noise alone
    std::vector<ChartedMode> modes;
    std::vector<ChartPoint> points; // mode by mode, from quick to careful
    std::vector<LeftOut> left_out;
    int kept = 0; // points that an earlier run had measured
    double seconds = 0;
};

// Whether other work ran beside it, which makes times longer.
inline bool was_loaded(const Chart& chart) { return chart.load_before > chart.threads + 0.5; }

struct ChartControl {
    std::atomic<bool>* cancel = nullptr;
    std::function<void(double)> progress;           // 0..1
    std::function<void(const std::string&)> remark; // a line on each point
};

// Points are kept in the job's directory as soon as they are measured; those that are there and made from the same
// scene, settings and number of threads are not measured again. Throws Error.
Chart make_chart(const Scene& scene, const ChartJob& job, const ChartControl& control);

// What a point is placed by: its time, and its error as it comes; no less than what the reference's noise hides.
enum class FrameTime { single, sequence };
enum class ErrorOf { worse, fog }; // picture or fog light, whichever is worse (E); fog light at pixel centres
double seconds_of(const ChartPoint& point, FrameTime time);
double error_of(const ChartPoint& point, ErrorOf what);

// Whether no other point is both as quick and as good, and better in one of the two.
bool unbeaten(const ChartPoint& point, std::span<const ChartPoint> points, FrameTime time, ErrorOf what);
void mark_best(std::vector<ChartPoint>& points);

// Where a point's pictures lie, relative to the directory: the picture, its error, and both small.
struct PointFiles {
    std::filesystem::path values, picture, errors, small_picture, small_errors;
};
PointFiles files_of(const ChartPoint& point);
}

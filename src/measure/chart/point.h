// One picture of a chart: rendered several times, timed, held against the reference. Internal to the chart.
#pragma once
#include "measure/chart/chart.h"
#include "trace/snapshot.h"

namespace tyndall {
// A frame of the short sequence that flicker is measured on.
struct SequenceFrame {
    Snapshot snapshot;
    int frame = 0;   // of the scene
    int pattern = 0; // of noise that changes from frame to frame
};

// All that the points of a chart share.
struct ChartStage {
    const Scene& scene;
    const ChartJob& job;
    Snapshot snapshot, next; // of the frame, and of the one after, which shares what stands still
    int next_frame = 0;
    std::vector<SequenceFrame> sequence;
    ivec2 sequence_size{0};
    // For modes that are measured by all light, and for those that are measured by that of the lights alone.
    ReferenceMetrics all, lights;
    ReferenceMetrics centers_all, centers_lights; // at pixel centres
    std::vector<ReferenceMetrics> sequence_all, sequence_lights;
    std::atomic<bool>* cancel = nullptr;
};

// A mode at one of its settings.
struct ChartRung {
    const Mode* mode;
    Candidate candidate;
    int place;
};
std::vector<ChartRung> rungs_of(const ChartJob& job);

// Whether ambient light, emission and background are left out of the mode's pictures: path would shadow and scatter
// them, which the reference does not.
bool lights_only(const Mode& mode);

// The settings of a rung; light scatters once.
Settings settings_of(const ChartRung& rung);

// What differs from the usual settings, as rows for --set with spaces between.
std::string rows_of(const Settings& settings);

// About the seconds that a picture will take, from a smaller one with few samples per pixel. Also wakes caches and what
// belongs to the scene's triangles.
double expected_seconds(const ChartStage& stage, const ChartRung& rung);

struct MeasuredPoint {
    ChartPoint point;
    Image<vec3> picture; // to look at
    Image<float> errors; // at each pixel, as a share of the reference's mean
};
MeasuredPoint measure_point(const ChartStage& stage, const ChartRung& rung,
                            const std::function<void(double)>& progress);
}

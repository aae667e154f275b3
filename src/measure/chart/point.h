// Measures one point of a chart: renders its image several times and compares it with the reference. Internal to the
// chart.
#pragma once
#include "measure/chart/chart.h"
#include "trace/snapshot.h"

namespace tyndall {
// A frame of the short sequence that flicker is measured on.
struct SequenceFrame {
    Snapshot snapshot;
    int frame = 0;   // of the scene
    int pattern = 0; // frame number that noise is seeded with
};

// What all points of a chart share.
struct ChartStage {
    const Scene& scene;
    const ChartJob& job;
    Snapshot snapshot, next; // of the frame, and of the one after, which shares what is static
    int next_frame = 0;
    std::vector<SequenceFrame> sequence;
    ivec2 sequence_size{0};
    // For modes that are compared by all light, and for those compared by the light of lamps and suns alone.
    ReferenceMetrics all, lights;
    ReferenceMetrics centers_all, centers_lights; // at pixel centers
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

// Whether ambient light, emission and background are left out of the mode's images: path would shadow and scatter them,
// which the reference does not.
bool lights_only(const Mode& mode);

// The settings of a rung; light scatters once.
Settings settings_of(const ChartRung& rung);

// The settings that differ from those of quality preview, as arguments of --set separated by spaces.
std::string rows_of(const Settings& settings);

// Estimates the seconds an image will take, from a smaller one with few samples per pixel. Also warms caches and builds
// what belongs to the scene's triangles.
double expected_seconds(const ChartStage& stage, const ChartRung& rung);

struct MeasuredPoint {
    ChartPoint point;
    Image<vec3> picture; // for display
    Image<float> errors; // at each pixel, relative to the reference's mean
};
MeasuredPoint measure_point(const ChartStage& stage, const ChartRung& rung,
                            const std::function<void(double)>& progress);
}

#include "measure/chart/chart.h"
#include "modes/mode.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
#define FIELD(member) [](ChartPoint& point) -> double& { return point.member; }
const std::vector<ChartField>& chart_fields() {
    static const std::vector<ChartField> fields{
        {"rung", "place on the mode's ladder of settings, 1 = the quickest", FIELD(rung)},
        {"samples", "camera rays per pixel", FIELD(samples)},
        {"runs", "how many times it was rendered", FIELD(runs)},
        {"setup_seconds", "before the first frame, on top of what each frame takes", FIELD(setup_seconds)},
        {"cpu_seconds", "processor time of a frame and its set-up, all threads together: median of the runs",
         FIELD(cpu_seconds)},
        {"frame_seconds", "a frame without its set-up: median of the runs", FIELD(frame_seconds)},
        {"frame_fastest", "the fastest run", FIELD(frame_fastest)},
        {"frame_slowest", "the slowest run", FIELD(frame_slowest)},
        {"seconds_1", "a single frame, set-up included", FIELD(seconds_1)},
        {"seconds_100", "each of 100 frames, set-up shared among them", FIELD(seconds_100)},
        {"memory_bytes", "peak memory on top of the scene", FIELD(memory_bytes)},
        {"error", "E: rmse_rel or inscatter_rmse_rel, whichever is larger", FIELD(errors.error)},
        {"uncertainty", "standard deviation of the error, from the reference's noise", FIELD(errors.uncertainty)},
        {"rmse_rel", "root of the mean squared difference / mean of the reference", FIELD(errors.rmse)},
        {"inscatter_rmse_rel", "the same for the light of the fog alone", FIELD(errors.inscatter_rmse)},
        {"inscatter_uncertainty", "standard deviation of that", FIELD(errors.inscatter_uncertainty)},
        {"bias_rel", "mean difference / mean of the reference", FIELD(errors.bias)},
        {"inscatter_bias_rel", "the same for the light of the fog alone", FIELD(errors.inscatter_bias)},
        {"rel_mse", "mean of squared difference / (squared reference + 0.01), scaled to a mean of 1",
         FIELD(errors.rel_mse)},
        {"flip", "mean HDR-FLIP: visible difference when flipping between both, 0 to 1", FIELD(errors.flip)},
        {"fog_error", "rmse_rel of the light of the fog at pixel centers, independent of rays per pixel",
         FIELD(fog_error)},
        {"fog_uncertainty", "standard deviation of that", FIELD(fog_uncertainty)},
        {"flicker", "changes between frames that the reference does not have / its mean, at pixel centers",
         FIELD(flicker)},
        {"gain", "of an artistic mode: best-fitting factor on its fog light", FIELD(gain)},
        {"fitted_error", "of an artistic mode: error with that gain", FIELD(fitted.error)},
        {"fitted_uncertainty", "standard deviation of that", FIELD(fitted.uncertainty)},
        {"fitted_rmse_rel", "rmse_rel with that gain", FIELD(fitted.rmse)},
        {"fitted_inscatter_rmse_rel", "inscatter_rmse_rel with that gain", FIELD(fitted.inscatter_rmse)},
        {"fitted_rel_mse", "rel_mse with that gain", FIELD(fitted.rel_mse)},
        {"fitted_flip", "flip with that gain", FIELD(fitted.flip)},
        {"fitted_fog_error", "fog_error with that gain", FIELD(fitted_fog_error)},
        {"best_1", "1: no other point has less error in less time, for a single frame", FIELD(best_1)},
        {"best_100", "the same for each of 100 frames", FIELD(best_100)},
        {"best_fog", "as best_1, by fog_error", FIELD(best_fog)},
        {"non_finite", "samples that were not finite numbers and were ignored", FIELD(non_finite)},
    };
    return fields;
}
#undef FIELD

double value_of(const ChartField& field, const ChartPoint& point) { return field.of(const_cast<ChartPoint&>(point)); }

std::string point_name(const ChartPoint& point) {
    return point.mode + "." + std::to_string(static_cast<int>(point.rung));
}

bool is_artistic(const ChartPoint& point) { return find_mode(point.mode).accuracy == Accuracy::artistic; }

PointFiles files_of(const ChartPoint& point) {
    const std::filesystem::path values = "points", pictures = "pictures";
    const std::string name = point_name(point);
    return {values / (name + ".json"), pictures / (name + ".png"), pictures / (name + ".error.png"),
            values / (name + ".jpg"), values / (name + ".error.jpg")};
}

double seconds_of(const ChartPoint& point, FrameTime time) {
    return time == FrameTime::single ? point.seconds_1 : point.seconds_100;
}

double error_of(const ChartPoint& point, ErrorOf what) {
    if (what == ErrorOf::worse) return std::max(point.errors.error, point.errors.uncertainty);
    return std::max(point.fog_error, point.fog_uncertainty);
}

bool is_pareto(const ChartPoint& point, std::span<const ChartPoint> points, FrameTime time, ErrorOf what) {
    const double seconds = seconds_of(point, time), error = error_of(point, what);
    if (!std::isfinite(error)) return false;
    return std::ranges::none_of(points, [&](const ChartPoint& other) {
        const double its_seconds = seconds_of(other, time), its_error = error_of(other, what);
        return its_seconds <= seconds && its_error <= error && (its_seconds < seconds || its_error < error);
    });
}

void mark_best(std::vector<ChartPoint>& points) {
    for (ChartPoint& point : points) {
        point.best_1 = is_pareto(point, points, FrameTime::single, ErrorOf::worse);
        point.best_100 = is_pareto(point, points, FrameTime::sequence, ErrorOf::worse);
        point.best_fog = is_pareto(point, points, FrameTime::single, ErrorOf::fog);
    }
}
}

// CSV, JSON and text.
#include "measure/chart/report.h"

#include "base/json/json.h"
#include "base/json/json_values.h"
#include "base/text.h"
#include "measure/chart/earlier_points.h"
#include "trace/snapshot.h"

#include <algorithm>

namespace tyndall {
namespace {
// Empty for what was not measured.
std::string csv_number(double value) { return std::isnan(value) ? "" : shortest_text(value); }

Json modes_json(const Chart& chart) {
    return json_list(chart.modes, [](const ChartedMode& mode) {
        return json_object(
            {{"name", mode.name}, {"promise", name_of(mode.accuracy)}, {"limitations", json_of(mode.limitations)}});
    });
}

Json advice_json(const Chart& chart) {
    const auto name = [](const std::optional<ChartPoint>& point) { return point ? Json(point_name(*point)) : Json(); };
    return json_list(advice_of(chart), [&](const Advice& advice) {
        const bool by_error = advice.error > 0;
        return json_object({{by_error ? "error" : "seconds", by_error ? advice.error : advice.seconds},
                            {"single", name(advice.single)},
                            {"sequence", name(advice.sequence)},
                            {"fog", name(advice.fog)}});
    });
}

Json left_out_json(const Chart& chart) {
    return json_list(chart.skipped, [](const SkippedRung& rung) {
        return json_object({{"mode", rung.mode},
                            {"rung", rung.rung},
                            {"settings", rung.settings},
                            {"expected_seconds", rung.seconds}});
    });
}

constexpr double max_advised_error = 0.5;

// The best point for a need, by the given kinds of time and error.
std::optional<ChartPoint> answer(const Chart& chart, const Advice& need, FrameTime time, ErrorOf what) {
    const ChartPoint* best = nullptr;
    for (const ChartPoint& point : chart.points) {
        const double seconds = seconds_of(point, time), error = error_of(point, what);
        if (need.error > 0 ? !(error <= need.error) : !(seconds <= need.seconds && error <= max_advised_error))
            continue;
        const bool better =
            !best || (need.error > 0 ? seconds < seconds_of(*best, time) : error < error_of(*best, what));
        if (better) best = &point;
    }
    return best ? std::optional(*best) : std::nullopt;
}
}

std::vector<Advice> advice_of(const Chart& chart) {
    std::vector<Advice> result;
    for (const double error : {0.2, 0.1, 0.05, 0.02, 0.01}) result.push_back({error, 0, {}, {}, {}});
    for (const double seconds : {1.0 / 30, 0.1, 1.0}) result.push_back({0, seconds, {}, {}, {}});
    for (Advice& advice : result) {
        advice.single = answer(chart, advice, FrameTime::single, ErrorOf::worse);
        advice.sequence = answer(chart, advice, FrameTime::sequence, ErrorOf::worse);
        advice.fog = answer(chart, advice, FrameTime::single, ErrorOf::fog);
    }
    return result;
}

std::string seconds_label(double seconds) {
    if (seconds < 0.00995) return formatted("%.1f ms", 1000 * seconds);
    if (seconds < 0.9995) return formatted("%.0f ms", 1000 * seconds);
    return formatted(seconds < 9.95 ? "%.1f s" : "%.0f s", seconds);
}

std::string percent_label(double share) {
    if (!std::isfinite(share)) return "-";
    const double percent = 100 * share, size = std::abs(percent);
    return formatted(size < 0.0995  ? "%.3f %%"
                     : size < 0.995 ? "%.2f %%"
                     : size < 9.95  ? "%.1f %%"
                                    : "%.0f %%",
                     percent);
}

std::string bytes_label(double bytes) {
    if (!std::isfinite(bytes)) return "-";
    return formatted(bytes < 9.95e6 ? "%.1f MB" : "%.0f MB", bytes / 1e6);
}

std::string goal_text(const Advice& advice) {
    if (advice.error > 0) return "an error of at most " + percent_label(advice.error);
    return "at most " + seconds_label(advice.seconds) + " per frame";
}

std::string chart_csv(const Chart& chart) {
    std::string text = "mode,settings";
    for (const ChartField& field : chart_fields()) text += "," + field.name;
    text += "\n";
    for (const ChartPoint& point : chart.points) {
        text += point.mode + ",\"" + point.settings + "\"";
        for (const ChartField& field : chart_fields()) text += "," + csv_number(value_of(field, point));
        text += "\n";
    }
    return text;
}

std::string chart_json(const Chart& chart) {
    const ChartJob& job = chart.job;
    const bool fixed = job.reference.count > 0;
    const auto field_json = [](const ChartField& field) {
        return json_object({{"name", field.name}, {"doc", field.doc}});
    };
    return json_line(
        {{"version", TYNDALL_VERSION},
         {"scene", job.render.scene_file.filename().string()},
         {"frame", job.frame},
         {"camera", chart.camera},
         {"size", chart.size},
         {"threads", chart.threads},
         {"isa", chart.isa},
         {"load_before", chart.load_before},
         {"load_after", chart.load_after},
         {"reference", json_object({{"samples", fixed ? job.reference.count : not_measured},
                                    {"noise_wanted", fixed ? not_measured : job.reference.noise},
                                    {"noise_rel", chart.reference_noise},
                                    {"flip_between_halves", chart.reference_flip}})},
         {"sequence", json_object({{"frames", job.sequence}, {"size", chart.sequence_size}, {"moves", chart.moves}})},
         {"fields", json_list(chart_fields(), field_json)},
         {"modes", modes_json(chart)},
         {"advice", advice_json(chart)},
         {"left_out", left_out_json(chart)},
         {"points", json_list(chart.points, json_of_point)}});
}

std::string skip_reason(const Chart& chart) {
    if (chart.skipped.empty()) return {};
    std::string text = count_text(chart.skipped.size(), "setting") + " skipped: an image would take more than " +
                       seconds_label(chart.job.longest) + " (--longest)";
    if (was_loaded(chart))
        text +=
            formatted("; other processes were running (load %.1f on %d threads), without them more settings may fit",
                      chart.load_before, chart.threads);
    return text;
}

std::string skipped_text(const SkippedRung& rung) {
    return rung.mode + " " + std::to_string(rung.rung) + ", " + seconds_label(rung.seconds) +
           " or more: " + rung.settings;
}

std::string chart_text(const Chart& chart) {
    std::string text;
    const auto words = [](const std::optional<ChartPoint>& point, ErrorOf what) {
        return point ? point_name(*point) + ", " + percent_label(error_of(*point, what)) + " in " +
                           seconds_label(point->seconds_1)
                     : std::string("none of these");
    };
    for (const Advice& advice : advice_of(chart))
        text += goal_text(advice) + ": " + words(advice.single, ErrorOf::worse) + "; for the technique alone " +
                words(advice.fog, ErrorOf::fog) + "\n";
    if (chart.skipped.empty()) return text;
    text += skip_reason(chart) + ":\n";
    for (const SkippedRung& rung : chart.skipped) text += "  " + skipped_text(rung) + "\n";
    return text;
}
}

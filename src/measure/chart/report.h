// A chart as files: CSV and JSON for programs, and a self-contained HTML page.
#pragma once
#include "measure/chart/chart.h"

#include <optional>

namespace tyndall {
std::string chart_csv(const Chart& chart);
std::string chart_json(const Chart& chart);
std::string chart_text(const Chart& chart); // a few lines: what to use when, and what was left out

// Why settings were left out; empty when none was.
std::string skip_reason(const Chart& chart);
std::string skipped_text(const SkippedRung& rung); // "march 5, 1.2 s or more: pixel.samples=64"

// A page with inline images, read from the chart's directory. Throws Error (unreadable).
std::string chart_html(const Chart& chart);

// Error against time, both logarithmic; the marks carry data-id="march.3" and the names of the `chart_page` styles.
std::string chart_svg(const Chart& chart, FrameTime time, ErrorOf what);
std::string chart_svg_file(const Chart& chart, FrameTime time, ErrorOf what); // with its style

// The points that meet a need: the fastest with an error of at most `error`, or the most accurate within `seconds`.
struct Advice {
    double error = 0, seconds = 0;                   // one of the two; the other is 0
    std::optional<ChartPoint> single, sequence, fog; // by E, for 1 and for 100 frames; by fog light, for 1
};
std::vector<Advice> advice_of(const Chart& chart);

// For people: "12 ms", "3.4 s"; "0.82 %", "120 %"; "12 MB".
std::string seconds_label(double seconds);
std::string percent_label(double share);
std::string bytes_label(double bytes);
std::string goal_text(const Advice& advice); // "an error of at most 5 %"

// A mode's color, distinguishable with color vision deficiency (Okabe and Ito 2008), and its marker shape.
struct MarkStyle {
    std::string color;
    int shape; // 0 to 7
};
MarkStyle style_of(const std::string& mode);
}

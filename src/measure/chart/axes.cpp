#include "measure/chart/axes.h"

#include "base/text.h"

#include <algorithm>

namespace tyndall::chart_drawing {
namespace {
constexpr int max_ticks = 8;

Axis axis_over(std::vector<double> values, double from, double to) {
    std::erase_if(values, [](double value) { return !(value > 0) || !std::isfinite(value); });
    if (values.empty()) return {0.01, 1, from, to};
    const auto [low, high] = std::ranges::minmax(values);
    Axis axis{low / 1.35, high * 1.35, from, to};
    if (axis.high < 8 * axis.low) axis.low /= 3, axis.high *= 3;
    return axis;
}

// 1, 2 and 5 of each decade within the axis; powers of ten are strong.
struct Tick {
    double value;
    bool strong, named;
};
std::vector<Tick> ticks_of(const Axis& axis) {
    std::vector<Tick> ticks;
    for (int decade = -7; decade <= 7; ++decade)
        for (const int digit : {1, 2, 5}) {
            const double value = digit * std::pow(10.0, decade);
            if (value >= axis.low && value <= axis.high) ticks.push_back({value, digit == 1, true});
        }
    if (ticks.size() > max_ticks)
        for (Tick& tick : ticks) tick.named = tick.strong;
    return ticks;
}

std::string tick_words(double seconds) {
    return seconds < 0.9 ? formatted("%g ms", 1000 * seconds) : formatted("%g s", seconds);
}
}

ChartFrame frame_of(const Chart& chart, FrameTime time, ErrorOf what) {
    ChartFrame frame{chart, time, what, {}, {}};
    std::vector<double> seconds, errors;
    for (const ChartPoint& point : chart.points) {
        if (!drawn(point)) continue;
        seconds.push_back(frame.seconds(point));
        errors.push_back(frame.value(point, false));
        if (is_artistic(point)) errors.push_back(frame.value(point, true));
    }
    frame.broken = std::erase_if(errors, [](double error) { return error > max_error; }) > 0;
    frame.x = axis_over(seconds, left, right);
    frame.y = axis_over(errors, bottom, frame.broken ? top + strip : top);
    return frame;
}

std::string n(double value) { return formatted("%.1f", value); }

std::string line(double x1, double y1, double x2, double y2, const char* style) {
    return "<line x1='" + n(x1) + "' y1='" + n(y1) + "' x2='" + n(x2) + "' y2='" + n(y2) + "' class='" + style +
           "'/>\n";
}

std::string text(double x, double y, const char* style, const std::string& words, const std::string& more) {
    return "<text x='" + n(x) + "' y='" + n(y) + "' class='" + style + "'" + more + ">" + words + "</text>\n";
}

std::string grid(const ChartFrame& frame) {
    std::string svg;
    for (const Tick& tick : ticks_of(frame.x)) {
        const double x = frame.x.at(tick.value);
        svg += line(x, frame.y.to, x, bottom, tick.strong ? "grid strong" : "grid");
        if (tick.named) svg += text(x, bottom + 20, "tick", tick_words(tick.value), " text-anchor='middle'");
    }
    for (const Tick& tick : ticks_of(frame.y)) {
        const double y = frame.y.at(tick.value);
        svg += line(left, y, right, y, tick.strong ? "grid strong" : "grid");
        if (tick.named)
            svg += text(left - 7, y + 5, "tick", formatted("%g %%", 100 * tick.value), " text-anchor='end'");
    }
    const std::string what = frame.time == FrameTime::single ? "time of a single frame, set-up included"
                                                             : "time of each of 100 frames, set-up shared among them";
    svg += text((left + right) / 2, bottom + 46, "axis", what, " text-anchor='middle'");
    const double middle = (top + bottom) / 2;
    const char* error = frame.what == ErrorOf::worse ? "error E" : "error of the fog light at pixel centers";
    return svg + text(17, middle, "axis", std::string(error) + " / mean",
                      " text-anchor='middle' transform='rotate(-90 17 " + n(middle) + ")'");
}

std::string strip_of(const ChartFrame& frame) {
    if (!frame.broken) return {};
    const double y = top + strip - 4;
    std::string svg = line(left, y - 4, right, y - 4, "break") + line(left, y, right, y, "break");
    return svg +
           text(left - 7, top + 0.45 * strip + 5, "tick", formatted("> %g %%", 100 * max_error), " text-anchor='end'");
}
}

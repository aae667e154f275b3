// The drawing of a chart as SVG, legible at the width of a column, on paper and on dark screens.
#include "measure/report/svg.h"
#include "base/text.h"
#include "measure/chart/page.h"
#include "measure/chart/report.h"
#include "modes/mode.h"

#include <algorithm>
#include <numbers>
#include <sstream>

namespace tyndall {
namespace {
constexpr double width = 640, left = 78, right = 626, top = 12, bottom = 400; // of the plot in the drawing
constexpr double legend_top = 474, legend_row = 23, legend_column = 152;
constexpr int legend_columns = 4, max_ticks = 8;

// Errors above max_error do not stretch the axis: they are drawn in a separate strip above a break.
constexpr double max_error = 2, strip = 40;

// A logarithmic axis, from values to pixels.
struct Axis {
    double low = 1, high = 10; // values at both ends
    double from = 0, to = 1;   // pixels
    double at(double value) const {
        const double share = std::log(value / low) / std::log(high / low);
        return from + std::clamp(share, 0.0, 1.0) * (to - from);
    }
};

struct Place {
    double x, y;
};

std::string n(double value) { return formatted("%.1f", value); }

bool drawn(const ChartPoint& point) { return std::isfinite(point.errors.error) && point.seconds_1 > 0; }

// The chart, the kinds of time and error on its axes, and the axes.
struct Frame {
    const Chart& chart;
    FrameTime time;
    ErrorOf what;
    Axis x, y;
    bool broken = false; // some errors lie in the strip

    double seconds(const ChartPoint& point) const { return seconds_of(point, time); }
    double error(const ChartPoint& point, bool fitted) const {
        if (!fitted) return error_of(point, what);
        return what == ErrorOf::worse ? point.fitted.error : point.fitted_fog_error;
    }
    double uncertainty(const ChartPoint& point, bool fitted) const {
        if (what == ErrorOf::fog) return point.fog_uncertainty;
        return fitted ? point.fitted.uncertainty : point.errors.uncertainty;
    }
    // An error below the reference's noise is drawn at that noise.
    double value(const ChartPoint& point, bool fitted) const {
        return std::max({error(point, fitted), uncertainty(point, fitted), 1e-6});
    }
    bool in_strip(const ChartPoint& point, bool fitted) const { return value(point, fitted) > max_error; }
    Place place(const ChartPoint& point, bool fitted) const {
        const double over = top + 0.45 * strip;
        return {x.at(seconds(point)), in_strip(point, fitted) ? over : y.at(value(point, fitted))};
    }
};

Axis axis_over(std::vector<double> values, double from, double to) {
    std::erase_if(values, [](double value) { return !(value > 0) || !std::isfinite(value); });
    if (values.empty()) return {0.01, 1, from, to};
    const auto [low, high] = std::ranges::minmax(values);
    Axis axis{low / 1.35, high * 1.35, from, to};
    if (axis.high < 8 * axis.low) axis.low /= 3, axis.high *= 3;
    return axis;
}

Frame frame_of(const Chart& chart, FrameTime time, ErrorOf what) {
    Frame frame{chart, time, what, {}, {}};
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

std::string line(double x1, double y1, double x2, double y2, const char* style) {
    return "<line x1='" + n(x1) + "' y1='" + n(y1) + "' x2='" + n(x2) + "' y2='" + n(y2) + "' class='" + style +
           "'/>\n";
}

std::string text(double x, double y, const char* style, const std::string& words, const std::string& more = {}) {
    return "<text x='" + n(x) + "' y='" + n(y) + "' class='" + style + "'" + more + ">" + words + "</text>\n";
}

std::string grid(const Frame& frame) {
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

// The break of the error axis, and its label.
std::string strip_of(const Frame& frame) {
    if (!frame.broken) return {};
    const double y = top + strip - 4;
    std::string svg = line(left, y - 4, right, y - 4, "break") + line(left, y, right, y, "break");
    return svg +
           text(left - 7, top + 0.45 * strip + 5, "tick", formatted("> %g %%", 100 * max_error), " text-anchor='end'");
}

// Regular polygons and stars by their corners, one shape for each mode.
std::string shape(int kind, Place at, double size) {
    if (kind == 0) return "<circle cx='" + n(at.x) + "' cy='" + n(at.y) + "' r='" + n(size) + "'/>";
    struct Shape {
        int corners;
        double turn, inner; // degrees; radius of every second corner
    };
    constexpr Shape shapes[] = {{},         {4, 45, 1},      {3, -90, 1},   {4, 0, 1},
                                {3, 90, 1}, {10, -90, 0.42}, {8, 45, 0.34}, {6, 0, 1}};
    const Shape& s = shapes[kind];
    std::string points;
    for (int i = 0; i < s.corners; ++i) {
        const double angle = (s.turn + 360.0 * i / s.corners) * std::numbers::pi / 180;
        const double radius = 1.25 * size * (i % 2 && s.inner < 1 ? s.inner : 1);
        points += n(at.x + radius * std::cos(angle)) + "," + n(at.y + radius * std::sin(angle)) + " ";
    }
    points.pop_back();
    return "<polygon points='" + points + "'/>";
}

// Error bars: the uncertainty of a point's error, and the range of its times.
std::string whiskers(const Frame& frame, const ChartPoint& point, bool fitted) {
    const auto [x, y] = frame.place(point, fitted);
    const double error = frame.error(point, fitted), uncertainty = frame.uncertainty(point, fitted);
    std::string svg;
    if (uncertainty > 0.1 * error && !frame.in_strip(point, fitted)) {
        const double low = error - 2 * uncertainty;
        svg += line(x, frame.y.at(error + 2 * uncertainty), x, low > 0 ? frame.y.at(low) : bottom, "whisker");
    }
    if (point.frame_slowest > 1.1 * point.frame_fastest) {
        const double more = frame.seconds(point) - point.frame_seconds;
        svg += line(frame.x.at(point.frame_fastest + more), y, frame.x.at(point.frame_slowest + more), y, "whisker");
    }
    return svg;
}

// Black stands for the text color, which is light on dark screens.
std::string ink(const std::string& mode) {
    const std::string color = style_of(mode).color;
    return color == "#000000" ? "currentColor" : color;
}

std::string colored(const std::string& mode, bool fitted, Place at) {
    const std::string color = ink(mode);
    const std::string style = fitted ? "class='hollow' stroke='" + color + "' stroke-width='2'"
                                     : "fill='" + color + "' stroke='currentColor' stroke-width='0.8'";
    return "<g " + style + ">" + shape(style_of(mode).shape, at, 6) + "</g>";
}

std::string mark(const Frame& frame, const ChartPoint& point, Place at, bool fitted) {
    const std::string id = point_name(point) + (fitted ? ".fitted" : "");
    const std::string words =
        id + ": " + percent_label(frame.error(point, fitted)) + ", " + seconds_label(frame.seconds(point));
    return "<g class='mark' data-id='" + id + "' tabindex='0' role='img' aria-label='" + words + "'>" +
           colored(point.mode, fitted, at) + "</g>\n";
}

// The drawing's layers, lines below marks, and what its legend shows.
struct Drawing {
    std::string lines, marks;
    std::vector<std::string> modes;     // that are drawn
    std::vector<std::string> over = {}; // errors in the strip, one text per mode
    bool fitted = false;                // an artistic mode is drawn again with its fitted gain
};

// The range of a mode's errors in the strip.
void note_strip(const Frame& frame, const std::string& mode, Drawing& drawing) {
    double low = infinity, high = 0;
    for (const ChartPoint& point : frame.chart.points)
        if (point.mode == mode && drawn(point) && frame.in_strip(point, false))
            low = std::min(low, frame.value(point, false)), high = std::max(high, frame.value(point, false));
    if (high == 0) return;
    const std::string from = percent_label(low), to = percent_label(high);
    drawing.over.push_back(mode + " " + from + (from == to ? "" : " to " + to));
}

// Adds a mode's marks and a line through them; `fitted`: with the fitted gain of an artistic mode.
void add_series(const Frame& frame, const std::string& mode, bool fitted, Drawing& drawing) {
    std::string path;
    for (const ChartPoint& point : frame.chart.points) {
        if (point.mode != mode || !drawn(point) || !std::isfinite(frame.error(point, fitted))) continue;
        const Place at = frame.place(point, fitted);
        path += (path.empty() ? "" : " ") + n(at.x) + "," + n(at.y);
        drawing.lines += whiskers(frame, point, fitted);
        drawing.marks += mark(frame, point, at, fitted);
    }
    if (path.empty()) return;
    drawing.lines += "<polyline points='" + path + "' class='series" + (fitted ? " fitted" : "") + "' stroke='" +
                     ink(mode) + "'/>\n";
    if (fitted) drawing.fitted = true;
    if (!fitted) drawing.modes.push_back(mode);
}

// The Pareto front: steps along the unbeaten points.
std::string front(const Frame& frame) {
    std::vector<Place> best;
    for (const ChartPoint& point : frame.chart.points)
        if (drawn(point) && is_pareto(point, frame.chart.points, frame.time, frame.what))
            best.push_back(frame.place(point, false));
    std::ranges::sort(best, {}, &Place::x);
    if (best.empty()) return {};
    std::string path = "M" + n(best[0].x) + " " + n(top);
    for (const Place& place : best)
        path += " L" + n(place.x) + " " + n(best.data() == &place ? top : (&place)[-1].y) + " L" + n(place.x) + " " +
                n(place.y);
    path += " L" + n(right) + " " + n(best.back().y);
    return "<path d='" + path + "' class='front'/>\n";
}

// The names of the marks in rows below the plot, and the errors in the strip. `end` returns their lower edge.
std::string legend(const Drawing& drawing, double& end) {
    std::string svg;
    int entries = 0;
    Place at{};
    const auto entry = [&](const std::string& words) {
        at = {left - 60 + legend_column * (entries % legend_columns),
              legend_top + legend_row * (entries / legend_columns)};
        ++entries;
        svg += text(at.x + 16, at.y + 5, "legend", words);
    };
    for (const std::string& mode : drawing.modes) {
        entry(mode);
        svg += colored(mode, false, at) + "\n";
    }
    if (drawing.fitted) {
        entry("gain fitted");
        svg += line(at.x - 10, at.y, at.x + 10, at.y, "series fitted quiet") + "<circle class='hollow quiet' cx='" +
               n(at.x) + "' cy='" + n(at.y) + "' r='5'/>\n";
    }
    entry("unbeaten");
    svg += line(at.x - 10, at.y, at.x + 10, at.y, "front");
    end = at.y + legend_row + 5;

    std::string over;
    for (const std::string& words : drawing.over) over += (over.empty() ? "above the break: " : ", ") + words;
    std::istringstream lines(wrapped(over, 84, 0));
    for (std::string words; std::getline(lines, words); end += 19)
        svg += text(left - 60 - 6, end, "tick", xml_text(words));
    return svg;
}
}

MarkStyle style_of(const std::string& mode) {
    constexpr int marks = 8;
    const auto row = std::ranges::find(modes(), mode, &Mode::name);
    if (row == modes().end()) return {"#000000", marks - 1};
    return {std::string(row->color), static_cast<int>(row - modes().begin()) % marks};
}

std::string chart_svg(const Chart& chart, FrameTime time, ErrorOf what) {
    const Frame frame = frame_of(chart, time, what);
    Drawing drawing;
    for (const ChartedMode& mode : chart.modes) {
        add_series(frame, mode.name, false, drawing);
        if (mode.accuracy == Accuracy::artistic) add_series(frame, mode.name, true, drawing);
        note_strip(frame, mode.name, drawing);
    }
    double height = 0;
    const std::string names = legend(drawing, height);
    return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + n(width) + " " + n(height) +
           "' class='chart' role='group' aria-label='error against time'>\n" + grid(frame) + strip_of(frame) +
           front(frame) + drawing.lines + drawing.marks + names + "</svg>\n";
}

std::string chart_svg_file(const Chart& chart, FrameTime time, ErrorOf what) {
    std::string svg = chart_svg(chart, time, what);
    const std::string paper = "<rect class='paper' width='100%' height='100%'/>\n";
    return svg.insert(svg.find('\n') + 1, "<style>" + std::string(chart_svg_style) + "</style>\n" + paper);
}
}

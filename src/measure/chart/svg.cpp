// The picture of a chart, as SVG.
#include "base/text.h"
#include "measure/chart/report.h"
#include "modes/mode.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr double width = 960, height = 600, left = 86, right = 130, top = 24, bottom = 62;

// A logarithmic axis onto pixels.
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

// What is drawn, and by what it is placed.
struct Frame {
    const Chart& chart;
    FrameTime time;
    ErrorOf what;
    Axis x, y;

    double seconds(const ChartPoint& point) const { return seconds_of(point, time); }
    double error(const ChartPoint& point, bool fitted) const {
        if (!fitted) return error_of(point, what);
        return what == ErrorOf::worse ? point.fitted.error : point.fitted_fog_error;
    }
    double uncertainty(const ChartPoint& point, bool fitted) const {
        if (what == ErrorOf::fog) return point.fog_uncertainty;
        return fitted ? point.fitted.uncertainty : point.errors.uncertainty;
    }
    // What is below the reference's noise lies on it.
    double value(const ChartPoint& point, bool fitted) const {
        return std::max({error(point, fitted), uncertainty(point, fitted), 1e-6});
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
        if (is_look(point)) errors.push_back(frame.value(point, true));
    }
    frame.x = axis_over(seconds, left, width - right), frame.y = axis_over(errors, height - bottom, top);
    return frame;
}

// 1, 2 and 5 of each decade within the axis; those of 1 are strong.
struct Tick {
    double value;
    bool strong;
};
std::vector<Tick> ticks_of(const Axis& axis) {
    std::vector<Tick> ticks;
    for (int decade = -7; decade <= 7; ++decade)
        for (const int digit : {1, 2, 5}) {
            const double value = digit * std::pow(10.0, decade);
            if (value >= axis.low && value <= axis.high) ticks.push_back({value, digit == 1});
        }
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
        svg += line(x, top, x, height - bottom, tick.strong ? "grid strong" : "grid");
        svg += text(x, height - bottom + 18, "tick", tick_words(tick.value), " text-anchor='middle'");
    }
    for (const Tick& tick : ticks_of(frame.y)) {
        const double y = frame.y.at(tick.value);
        svg += line(left, y, width - right, y, tick.strong ? "grid strong" : "grid");
        svg += text(left - 8, y + 4, "tick", formatted("%g %%", 100 * tick.value), " text-anchor='end'");
    }
    const std::string what = frame.time == FrameTime::single ? "time of a single frame, set-up included"
                                                             : "time of each of 100 frames, set-up shared among them";
    svg += text((left + width - right) / 2, height - 16, "axis", what, " text-anchor='middle'");
    const double middle = (top + height - bottom) / 2;
    const char* error = frame.what == ErrorOf::worse ? "error E of the picture or its fog light, whichever is worse"
                                                     : "error of the fog light at pixel centres";
    svg += text(18, middle, "axis", std::string(error) + " / mean",
                " text-anchor='middle' transform='rotate(-90 18 " + n(middle) + ")'");
    return svg;
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
        const double angle = (s.turn + 360.0 * i / s.corners) * 3.14159265358979323846 / 180;
        const double radius = 1.25 * size * (i % 2 && s.inner < 1 ? s.inner : 1);
        points += n(at.x + radius * std::cos(angle)) + "," + n(at.y + radius * std::sin(angle)) + " ";
    }
    points.pop_back();
    return "<polygon points='" + points + "'/>";
}

// Where points lie, and how uncertain that is.
std::string whiskers(const Frame& frame, const ChartPoint& point, bool fitted) {
    const double x = frame.x.at(frame.seconds(point)), y = frame.y.at(frame.value(point, fitted));
    const double error = frame.error(point, fitted), uncertainty = frame.uncertainty(point, fitted);
    std::string svg;
    if (uncertainty > 0.1 * error) {
        const double low = error - 2 * uncertainty;
        svg += line(x, frame.y.at(error + 2 * uncertainty), x, low > 0 ? frame.y.at(low) : height - bottom, "whisker");
    }
    if (point.frame_slowest > 1.1 * point.frame_fastest) {
        const double more = frame.seconds(point) - point.frame_seconds;
        svg += line(frame.x.at(point.frame_fastest + more), y, frame.x.at(point.frame_slowest + more), y, "whisker");
    }
    return svg;
}

std::string mark(const Frame& frame, const ChartPoint& point, Place at, bool fitted) {
    const MarkStyle style = style_of(point.mode);
    const std::string id = point_name(point) + (fitted ? ".fitted" : "");
    const std::string words =
        id + ": " + share_words(frame.error(point, fitted)) + ", " + seconds_words(frame.seconds(point));
    return "<g class='mark' data-id='" + id + "' tabindex='0' role='img' aria-label='" + words + "' fill='" +
           (fitted ? "#fff" : style.color) + "' stroke='" + (fitted ? style.color : "#222") + "' stroke-width='" +
           (fitted ? "2" : "0.8") + "'>" + shape(style.shape, at, 6) + "</g>\n";
}

struct Label {
    double x, y;
    std::string words, color;
};

// What lies over what: lines, their names, marks.
struct Drawing {
    std::string lines, marks;
    std::vector<Label> labels;
};

// A mode's marks with a line through them; looks a second time with the gain that fits them.
void add_series(const Frame& frame, const std::string& mode, bool fitted, Drawing& drawing) {
    std::string path;
    Place last{};
    for (const ChartPoint& point : frame.chart.points) {
        if (point.mode != mode || !drawn(point) || !std::isfinite(frame.error(point, fitted))) continue;
        last = {frame.x.at(frame.seconds(point)), frame.y.at(frame.value(point, fitted))};
        path += (path.empty() ? "" : " ") + n(last.x) + "," + n(last.y);
        drawing.lines += whiskers(frame, point, fitted);
        drawing.marks += mark(frame, point, last, fitted);
    }
    if (path.empty()) return;
    const std::string color = style_of(mode).color;
    drawing.labels.push_back({last.x + 11, last.y + 4, mode + (fitted ? ", gain fitted" : ""), color});
    drawing.lines +=
        "<polyline points='" + path + "' class='series" + (fitted ? " fitted" : "") + "' stroke='" + color + "'/>\n";
}

// Steps along the points that nothing beats.
std::string front(const Frame& frame) {
    std::vector<Place> best;
    for (const ChartPoint& point : frame.chart.points)
        if (drawn(point) && unbeaten(point, frame.chart.points, frame.time, frame.what))
            best.push_back({frame.x.at(frame.seconds(point)), frame.y.at(frame.value(point, false))});
    std::ranges::sort(best, {}, &Place::x);
    if (best.empty()) return {};
    std::string path = "M" + n(best[0].x) + " " + n(top);
    for (const Place& place : best)
        path += " L" + n(place.x) + " " + n(best.data() == &place ? top : (&place)[-1].y) + " L" + n(place.x) + " " +
                n(place.y);
    path += " L" + n(width - right) + " " + n(best.back().y);
    return "<path d='" + path + "' class='front'/>\n";
}

// Labels of lines that end close together move apart.
std::string placed(std::vector<Label> labels) {
    constexpr double line_height = 15;
    std::ranges::sort(labels, {}, &Label::y);
    std::string svg;
    for (size_t i = 0; i < labels.size(); ++i)
        for (size_t k = 0; k < i; ++k)
            if (std::abs(labels[i].x - labels[k].x) < 110 && labels[i].y < labels[k].y + line_height &&
                labels[i].y > labels[k].y - line_height)
                labels[i].y = labels[k].y + line_height;
    for (const Label& label : labels)
        svg += text(label.x, label.y, "label", label.words, " fill='" + label.color + "'");
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
    }
    return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + n(width) + " " + n(height) +
           "' class='chart' role='group' aria-label='error against time'>\n" + grid(frame) + front(frame) +
           drawing.lines + placed(drawing.labels) + drawing.marks + "</svg>\n";
}
}

// The drawing of a chart as SVG, legible at the width of a column, on paper and on dark screens.
#include "measure/report/svg.h"
#include "base/text.h"
#include "measure/chart/axes.h"
#include "measure/chart/page.h"
#include "modes/mode.h"

#include <algorithm>
#include <numbers>
#include <sstream>

namespace tyndall {
namespace {
using namespace chart_drawing;
constexpr double legend_top = 474, legend_row = 23, legend_column = 152;
constexpr int legend_columns = 4;

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
std::string whiskers(const ChartFrame& frame, const ChartPoint& point, bool fitted) {
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

std::string mark(const ChartFrame& frame, const ChartPoint& point, Place at, bool fitted) {
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
void note_strip(const ChartFrame& frame, const std::string& mode, Drawing& drawing) {
    double low = infinity, high = 0;
    for (const ChartPoint& point : frame.chart.points)
        if (point.mode == mode && drawn(point) && frame.in_strip(point, false))
            low = std::min(low, frame.value(point, false)), high = std::max(high, frame.value(point, false));
    if (high == 0) return;
    const std::string from = percent_label(low), to = percent_label(high);
    drawing.over.push_back(mode + " " + from + (from == to ? "" : " to " + to));
}

// Adds a mode's marks and a line through them; `fitted`: with the fitted gain of an artistic mode.
void add_series(const ChartFrame& frame, const std::string& mode, bool fitted, Drawing& drawing) {
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
std::string front(const ChartFrame& frame) {
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
    const ChartFrame frame = frame_of(chart, time, what);
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

// The axes of a chart's drawing: where errors and times lie, and the grid behind them.
#pragma once
#include "measure/chart/report.h"

namespace tyndall::chart_drawing {
inline constexpr double width = 640, left = 78, right = 626, top = 12, bottom = 400; // of the plot in the drawing

// Errors above max_error do not stretch the axis: they are drawn in a separate strip above a break.
inline constexpr double max_error = 2, strip = 40;

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

// Whether the chart shows a point.
inline bool drawn(const ChartPoint& point) { return std::isfinite(point.errors.error) && point.seconds_1 > 0; }

// The chart, the kinds of time and error on its axes, and the axes.
struct ChartFrame {
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

ChartFrame frame_of(const Chart& chart, FrameTime time, ErrorOf what);

// A coordinate, a line and text as SVG.
std::string n(double value);
std::string line(double x1, double y1, double x2, double y2, const char* style);
std::string text(double x, double y, const char* style, const std::string& words, const std::string& more = {});

// The lines of the grid, with the names of ticks and axes.
std::string grid(const ChartFrame& frame);

// The break of the error axis, and its label.
std::string strip_of(const ChartFrame& frame);
}

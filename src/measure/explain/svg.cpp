// The drawing: panels over one axis of distance, and bars for the modes.
#include "measure/explain/svg.h"

#include "base/text.h"
#include "measure/explain/curves.h"

#include <algorithm>

namespace tyndall {
using namespace ray_drawing;

namespace {
constexpr size_t max_lights = 7; // drawn, brightest first
constexpr const char* fog_color = "#8c8c8c";
constexpr const char* dark_color = "#4d4d4d";

// Distinguishable with color vision deficiency (Okabe and Ito 2008).
constexpr const char* light_colors[max_lights] = {"#E69F00", "#0072B2", "#009E73", "#D55E00",
                                                  "#CC79A7", "#56B4E9", "#7a5c00"};

// Maps the values of one panel to the drawing.
struct Panel {
    double top, bottom;
    Interval<double> range; // of distances, from left to right
    double y_end;           // values 0..y_end from bottom to top
    double x(double value) const {
        return left + (right - left) * std::clamp((value - range.low) / range.length(), 0.0, 1.0);
    }
    double y(double value) const { return bottom - (bottom - top) * std::clamp(value / y_end, 0.0, 1.0); }
};

void draw_axes(const Panel& panel, const std::string& title, bool percents, bool distances, Svg& svg) {
    const double x_tick = tick_of(panel.range.length(), 10);
    for (double x = std::ceil(panel.range.low / x_tick) * x_tick; x <= panel.range.high + 1e-4 * panel.range.length();
         x += x_tick) {
        svg.line(panel.x(x), panel.top, panel.x(x), panel.bottom, "#e6e6e6", 1);
        if (distances) svg.text(panel.x(x), panel.bottom + 16, digits(x), Anchor::middle);
    }
    const double y_tick = percents ? 0.25 : tick_of(panel.y_end, 4);
    for (double y = 0; panel.y_end > 0 && y <= panel.y_end * 1.0001; y += y_tick) {
        svg.line(left, panel.y(y), right, panel.y(y), "#e6e6e6", 1);
        svg.text(left - 6, panel.y(y) + 4, percents ? digits(100 * y) + " %" : digits(y), Anchor::end);
    }
    svg.line(left, panel.top, left, panel.bottom, ink, 1), svg.line(left, panel.bottom, right, panel.bottom, ink, 1);
    svg.text(left, panel.top - 7, title, Anchor::start, "font-weight='bold'");
}

// A curve through the middles of steps, one value per step; broken where drawn(i) is false, and with a jump to the next
// step where joins(i) is false.
template<class Value, class Drawn, class Joins>
std::string curve(const RayReport& report, const Panel& panel, const Value& value, const Drawn& drawn,
                  const Joins& joins) {
    std::string path;
    bool going = false; // on from the step before
    for (size_t i = 0; i < report.steps.size() && report.steps[i].low < panel.range.high; ++i) {
        const RayStep& step = report.steps[i];
        if (!drawn(i)) {
            going = false;
            continue;
        }
        const double y = panel.y(value(i));
        if (!going) path += formatted("M%.1f %.2f", panel.x(step.low), y);
        path += formatted("L%.1f %.2f", panel.x(step.middle()), y);
        const bool next = i + 1 < report.steps.size() && drawn(i + 1) &&
                          report.steps[i + 1].low <= step.high + 1e-6 * panel.range.high;
        if (!next || !joins(i)) path += formatted("H%.1f", panel.x(step.high));
        if (next && !joins(i)) path += formatted("V%.2f", panel.y(value(i + 1)));
        going = next;
    }
    return path;
}

template<class Value> std::string curve(const RayReport& report, const Panel& panel, const Value& value) {
    const auto always = [](size_t) { return true; };
    return curve(report, panel, value, always, always);
}

void draw_fog(const RayReport& report, double top, Interval<double> range, Svg& svg) {
    double most = 0;
    for (const RayStep& step : report.steps)
        if (step.low < range.high) most = std::max(most, step.extinction);
    const Panel panel{top, top + 100, range, most > 0 ? 1.1 * most : 1};
    draw_axes(panel, "Fog on the ray: extinction, 1/m", false, false, svg);
    if (report.steps.empty()) return svg.text(0.5 * (left + right), top + 55, "no fog on this ray", Anchor::middle);
    const std::string path = curve(report, panel, [&](size_t i) { return report.steps[i].extinction; });
    const double last = std::min(report.steps.back().high, range.high);
    svg.path(path + formatted("V%.1fH%.1fZ", panel.bottom, panel.x(report.steps.front().low)), "none", 0, "#cfcfcf");
    svg.path(path, fog_color, 1.2);
    if (last < range.high) svg.line(panel.x(last), panel.bottom, right, panel.bottom, ink, 1);
}

void draw_transmittance(const RayReport& report, std::span<const size_t> lights, double top, Interval<double> range,
                        Svg& svg) {
    const Panel panel{top, top + 130, range, 1};
    draw_axes(panel, "Transmittance of the fog: from here to the camera (black), from each light to here (color)", true,
              false, svg);
    for (size_t i = 0; i < lights.size(); ++i) {
        const LightOnRay& light = report.lights[lights[i]];
        const std::vector<LightState> states = light_states(report, light);
        const auto reached = [&](size_t s) { return states[s] != LightState::out_of_reach; };
        const auto value = [&](size_t s) { return light.at[s].transmittance; };
        svg.path(curve(report, panel, value, reached, [](size_t) { return true; }), light_colors[i], 1.6);
    }
    svg.path(curve(report, panel, [&](size_t s) { return report.steps[s].to_eye; }), ink, 2);
}

void draw_light(const RayReport& report, std::span<const size_t> lights, double top, Interval<double> range, Svg& svg) {
    double most = 0;
    const double scale = light_scale(report, most);
    const Panel panel{top, top + 150, range, scale};
    std::string title =
        "Light scattered here that arrives at the camera, nits per meter (gray: ambient light and emission)";
    if (most > 1.1 * scale) title += formatted("; clipped, up to %.3g", most);
    draw_axes(panel, title, false, false, svg);
    svg.path(curve(report, panel, [&](size_t s) { return eye_luminance(report.steps[s], report.steps[s].glow); }),
             fog_color, 1.2);
    for (size_t i = 0; i < lights.size(); ++i) {
        const LightOnRay& light = report.lights[lights[i]];
        const std::vector<LightState> states = light_states(report, light);
        const auto shines = [&](size_t s) { return states[s] != LightState::out_of_reach; };
        const auto half = [&](size_t s) { return states[s] == LightState::partial; };
        const auto goes_on = [&](size_t s) { return states[s] == states[s + 1] || half(s) || half(s + 1); };
        const auto value = [&](size_t s) { return eye_luminance(report.steps[s], light.at[s].scattered); };
        svg.path(curve(report, panel, value, shines, goes_on), light_colors[i], 1.6);
    }
}

// A light's row: its color where it shines, paler in penumbra, dark in shadow, a thin line beyond its reach.
void draw_stretch(const Panel& panel, const LightStretch& stretch, double y, const char* color, Svg& svg) {
    if (stretch.low >= panel.range.high || stretch.high <= panel.range.low) return;
    const double from = panel.x(stretch.low), to = panel.x(stretch.high);
    const std::string names = joined(stretch.blockers, ", ");
    std::string tip = formatted("%.3f to %.3f m: ", stretch.low, stretch.high) + std::string(name_of(stretch.state));
    if (!names.empty()) tip += " of " + names;
    switch (stretch.state) {
    case LightState::full:
        return svg.bar(from, y, to - from, 16, color, 1, tip);
    case LightState::partial:
        return svg.bar(from, y, to - from, 16, color, 0.25 + 0.5 * stretch.share, tip);
    case LightState::out_of_reach:
        return svg.bar(from, y + 7.5, to - from, 1, "#999", 1, tip);
    case LightState::shadowed:
        break;
    }
    svg.bar(from, y, to - from, 16, dark_color, 1, tip);
    for (const std::string& text : {names, stretch.blockers.empty() ? std::string() : stretch.blockers[0]})
        if (!text.empty() && text_width(text) + 8 < to - from)
            return svg.text(0.5 * (from + to), y + 12, text, Anchor::middle, "fill='#fff'");
}

double draw_lit(const RayReport& report, std::span<const size_t> lights, double top, Interval<double> range, Svg& svg) {
    const Panel panel{top, top + 24 * static_cast<double>(lights.size()) + 4, range, 1};
    std::string title =
        "Where each light shines: color lit, pale penumbra, dark in the shadow of the named object, line "
        "out of reach";
    if (lights.size() < report.lights.size())
        title += formatted(" (%zu of %zu lights)", lights.size(), report.lights.size());
    draw_axes({panel.top, panel.bottom, range, 0}, title, false, true, svg);
    for (size_t i = 0; i < lights.size(); ++i) {
        const LightOnRay& light = report.lights[lights[i]];
        const double y = top + 4 + 24 * static_cast<double>(i);
        svg.text(left - 8, y + 12, shortened(light.name, left - 16), Anchor::end,
                 formatted("fill='%s'", light_colors[i]).c_str());
        for (const LightStretch& stretch : light.stretches) draw_stretch(panel, stretch, y, light_colors[i], svg);
    }
    svg.text(0.5 * (left + right), panel.bottom + 32, "distance from the camera, m", Anchor::middle);
    return panel.bottom + 40;
}

// Lines across all panels where the ray meets surfaces.
void draw_surfaces(const RayReport& report, double top, double bottom, Interval<double> range, Svg& svg) {
    const Panel panel{top, bottom, range, 1};
    for (const SurfaceOnRay& surface : report.surfaces) {
        const bool there = surface.distance <= range.high * 1.0001;
        if (surface.alpha < 1 && !there) continue;
        const std::string name = surface.name + formatted(", %.4g m", surface.distance) + (there ? "" : " →");
        const double x = panel.x(surface.distance);
        if (there) svg.line(x, top - 12, x, bottom, ink, 1, surface.alpha < 1 ? "4 3" : "");
        svg.text(x - 4, top - 16, name, x - text_width(name) < left ? Anchor::start : Anchor::end);
    }
}
}

std::string explain_svg(const RayReport& report, const ReportTitle& title) {
    const Interval<double> range = axis_of(report);
    const std::vector<size_t> lights = brightest_lights(report, max_lights);
    Svg svg;
    svg.text(16, 26, title_line(report, title), Anchor::start, "font-size='15' font-weight='bold'");
    draw_fog(report, 78, range, svg);
    draw_transmittance(report, lights, 210, range, svg);
    draw_light(report, lights, 372, range, svg);
    const double bottom = draw_lit(report, lights, 554, range, svg);
    draw_surfaces(report, 66, bottom - 40, range, svg);
    return svg.finished(width, draw_modes(report, bottom + 26, svg), title_line(report, title));
}
}

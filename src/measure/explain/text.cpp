// The text report.
#include "measure/explain/text.h"

#include "base/error.h"
#include "base/text.h"
#include "measure/report/grid_report.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr size_t columns = 100;

std::string surface_text(const SurfaceOnRay& surface) {
    std::string text = formatted("  %9s m  ", digits(surface.distance).c_str()) + printable(surface.name, 40);
    if (!surface.material.empty()) text += " (" + printable(surface.material, 40) + ")";
    if (surface.alpha < 1) text += ", alpha " + digits(surface.alpha);
    return report_lines(
        text + ": radiance " + color_text(surface.radiance) + ", " + percent(surface.share) + " of it arrives", 13);
}

std::string ray_text(const RayReport& report) {
    std::string text = "The ray\n";
    text += "  from " + place_text(report.origin, report.world_origin) + " m towards " + color_text(report.direction) +
            "\n";
    if (report.steps.empty()) {
        text += "  no fog along it\n";
    } else {
        std::string media;
        for (const MediumOnRay& medium : report.media)
            if (medium.depth > 0)
                media += (media.empty() ? "" : " + ") + printable(medium.name, 40) + " " + digits(medium.depth);
        text +=
            report_lines("  fog from " + digits(report.steps.front().low) + " to " + digits(report.steps.back().high) +
                             " m, optical depth " + digits(report.depth) + " (" + media +
                             "): " + percent(report.reference.transmittance) + " of the light behind it gets through",
                         6);
    }
    for (const SurfaceOnRay& surface : report.surfaces) text += surface_text(surface);
    if (!report.hits)
        text += "     behind    background: radiance " + color_text(report.background) + ", " +
                percent(report.background_share) + " of it arrives\n";
    return text;
}

// Meters of the ray on which a light has this state.
double length_of(const LightOnRay& light, LightState state) {
    double sum = 0;
    for (const LightStretch& stretch : light.stretches)
        if (stretch.state == state) sum += stretch.high - stretch.low;
    return sum;
}

std::string lights_text(const RayReport& report) {
    std::string text = "Light that reaches the camera, nits (other: ambient light, emission, background)\n";
    text += formatted("  %-16s %-9s %29s %29s\n", "", "", "scattered by fog", "reflected by surfaces");
    text += formatted("  %-16s %-9s %s %s %8s\n", "", "", channels().c_str(), channels().c_str(), "lit, m");
    const auto row = [&](const std::string& name, std::string_view kind, vec3 fog, vec3 surfaces,
                         const std::string& lit) {
        text += formatted("  %-16s %-9s %s %s %8s\n", cut(printable(name, 40), 16).c_str(), std::string(kind).c_str(),
                          color_columns(fog).c_str(), color_columns(surfaces).c_str(), lit.c_str());
    };
    vec3 of_lights(0);
    for (const LightOnRay& light : report.lights) {
        row(light.name, traits_of(light.kind).name, light.fog, light.surfaces,
            digits(length_of(light, LightState::full)));
        of_lights += light.surfaces;
    }
    const vec3 behind = report.reference.color - report.reference.inscatter;
    row("other", "", report.glow, glm::max(behind - of_lights, vec3(0)), "");
    row("all", "", report.reference.inscatter, behind, "");
    return text;
}

std::string stretches_text(const RayReport& report) {
    std::string text = "Where each light shines on the ray\n";
    for (const LightOnRay& light : report.lights) {
        std::string name = cut(printable(light.name, 40), 16);
        for (const LightStretch& stretch : light.stretches) {
            std::string line = formatted("  %-16s %9.3f %9.3f m   ", name.c_str(), stretch.low, stretch.high);
            line += name_of(stretch.state);
            if (!stretch.blockers.empty()) line += " of " + printable(joined(stretch.blockers, ", "), 200);
            if (stretch.state == LightState::partial) line += ", " + percent(stretch.share) + " lit";
            text += report_lines(line, 45);
            name.clear();
        }
    }
    if (!report.steps.empty() && std::ranges::any_of(report.lights, &LightOnRay::sampled))
        text += "  (shadows of MASK and BLEND surfaces are sampled, as in the steps)\n";
    return text;
}
}

std::string color_text(vec3 v) { return digits(v.x) + " " + digits(v.y) + " " + digits(v.z); }

std::string color_columns(vec3 v) {
    return formatted("%9s %9s %9s", digits(v.x).c_str(), digits(v.y).c_str(), digits(v.z).c_str());
}

std::string channels() { return formatted("%9s %9s %9s", "R", "G", "B"); }

std::string cut(std::string text, size_t most) { return text.size() <= most ? text : text.substr(0, most - 1) + "~"; }

std::string report_lines(const std::string& text, size_t indent) {
    std::string result, line;
    for (size_t start = 0; start < text.size();) {
        const size_t space = std::min(text.find(' ', start), text.size());
        const std::string word = text.substr(start, space - start);
        if (!line.empty() && line.size() + 1 + word.size() > columns) {
            result += line + "\n";
            line = std::string(indent, ' ') + word;
        } else {
            line += (start == 0 ? "" : " ") + word;
        }
        start = space + 1;
    }
    return result + line + "\n";
}

std::string digits(double value) { return formatted("%.4g", value); }

std::string percent(double share) {
    const double value = 100 * share;
    return formatted(value == 0 || value >= 99.95 ? "%.0f %%"
                     : value < 0.01               ? "%.0e %%"
                     : value < 10                 ? "%.2f %%"
                                                  : "%.1f %%",
                     value);
}

std::string difference_text(const ModeResult& result, const ModeResult& reference) {
    const double off = difference(result, reference);
    if (std::isinf(off)) return "none expected";
    const auto text = [](double value, const char* sign) {
        const double size = std::abs(100 * value);
        return formatted(size >= 100 ? "%s%.0f" : size >= 10 ? "%s%.1f" : "%s%.2f", sign, size);
    };
    std::string difference = std::abs(off) < 5e-5 ? "0.00" : text(off, off < 0 ? "-" : "+");
    if (result.standard_error && luminance(reference.inscatter) > 0)
        difference += " +- " + text(luminance(*result.standard_error) / luminance(reference.inscatter), "");
    return difference + " %";
}

vec3 added_by(const RayReport& report, size_t step) {
    vec3 sum = report.steps[step].glow;
    for (const LightOnRay& light : report.lights) sum += light.at[step].scattered;
    return static_cast<float>(report.steps[step].reach) * sum;
}

std::string title_line(const RayReport& report, const ReportTitle& title) {
    std::string text = printable(title.scene, 60) + formatted(", frame %d", title.frame);
    if (!title.camera.empty()) text += ", camera " + printable(title.camera, 40);
    return text + formatted(", pixel %d,%d of %dx%d, ", report.pixel.x, report.pixel.y, report.size.x, report.size.y) +
           title.quality;
}

std::string explain_text(const RayReport& report, const ReportTitle& title) {
    std::string text = report_lines(title_line(report, title), 2);
    for (const std::string& part : {ray_text(report), lights_text(report), stretches_text(report), steps_text(report),
                                    modes_text(report), limitations_text(report)})
        if (!part.empty()) text += "\n" + part;
    // Removes the blanks that empty cells leave at the ends of lines.
    std::string result;
    for (const char c : text) {
        if (c == '\n')
            while (result.ends_with(' ')) result.pop_back();
        result += c;
    }
    return result;
}
}

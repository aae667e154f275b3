// The table of steps as text.
#include "measure/explain/text.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int max_rows = 20;
constexpr size_t max_light_columns = 4;

// Steps merged over one stretch of the ray.
struct Row {
    double low = 0, high = 0, depth = 0, reach = 0;
    dvec3 source{0}, added{0};           // radiance per meter, times meters; light at the eye
    std::vector<double> share, to_light; // of each light, times meters
};

Row row_of(const RayReport& report, double low, double high) {
    Row row{low,
            high,
            0,
            0,
            dvec3(0),
            dvec3(0),
            std::vector<double>(report.lights.size()),
            std::vector<double>(report.lights.size())};
    for (size_t i = 0; i < report.steps.size(); ++i) {
        const RayStep& step = report.steps[i];
        const double length = std::min(high, step.high) - std::max(low, step.low);
        if (!(length > 0)) continue;
        const double part = length / (step.high - step.low);
        row.depth += step.extinction * length, row.reach += step.reach * part;
        row.source += length * dvec3(step.glow), row.added += part * dvec3(added_by(report, i));
        for (size_t l = 0; l < report.lights.size(); ++l) {
            row.source += length * dvec3(report.lights[l].at[i].scattered);
            row.share[l] += length * report.lights[l].at[i].share;
            row.to_light[l] += length * report.lights[l].at[i].transmittance;
        }
    }
    return row;
}

// Ends of rows at round distances.
std::vector<double> row_ends(const RayReport& report) {
    const double low = report.steps.front().low, high = report.steps.back().high;
    double length = std::pow(10.0, std::floor(std::log10((high - low) / max_rows)));
    for (const double factor : {2.0, 2.5, 2.0})
        if ((high - low) / length > max_rows - 1) length *= factor;
    std::vector<double> ends{low};
    for (double end = (std::floor(low / length) + 1) * length; end < high; end += length) ends.push_back(end);
    ends.push_back(high);
    return ends;
}

// The lights that contribute most of the fog light.
std::vector<size_t> main_lights(const RayReport& report) {
    std::vector<size_t> all;
    for (size_t l = 0; l < report.lights.size(); ++l)
        if (luminance(report.lights[l].fog) > 0) all.push_back(l);
    std::ranges::stable_sort(
        all, [&](size_t a, size_t b) { return luminance(report.lights[a].fog) > luminance(report.lights[b].fog); });
    all.resize(std::min(all.size(), max_light_columns));
    return all;
}
}

std::string steps_text(const RayReport& report) {
    if (report.steps.empty()) return {};
    const std::vector<size_t> lights = main_lights(report);
    const bool both = 2 * lights.size() <= max_light_columns;
    std::string text = "Step by step (luminance, nits)\n";
    if (!lights.empty()) text += std::string(67, ' ');
    for (const size_t l : lights)
        text += formatted(both ? " %17s" : " %8s", cut(printable(report.lights[l].name, 40), both ? 17 : 8).c_str());
    if (!lights.empty()) text += "\n";
    text += formatted("  %8s %8s %9s %8s %8s %10s %10s", "from, m", "to, m", "fog, 1/m", "depth", "to eye", "per meter",
                      "arrives");
    for (size_t l = 0; l < lights.size(); ++l) text += formatted(both ? " %8s %8s" : " %8s", "lit", "to light");
    text += "\n";
    dvec3 sum(0);
    double depth = 0;
    const std::vector<double> ends = row_ends(report);
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
        const Row row = row_of(report, ends[i], ends[i + 1]);
        const double length = row.high - row.low;
        depth += row.depth, sum += row.added;
        text +=
            formatted("  %8.3f %8.3f %9s %8s %8s %10s %10s", row.low, row.high, digits(row.depth / length).c_str(),
                      digits(depth).c_str(), percent(row.reach / length).c_str(),
                      digits(luminance(vec3(row.source / length))).c_str(), digits(luminance(vec3(row.added))).c_str());
        for (const size_t l : lights) {
            text += formatted(" %8s", percent(row.share[l] / length).c_str());
            if (both) text += formatted(" %8s", percent(row.to_light[l] / length).c_str());
        }
        text += "\n";
    }
    const double all = luminance(vec3(sum)), exact = luminance(report.reference.inscatter);
    text += formatted("  %zu steps add up to %s, the reference is %s", report.steps.size(), digits(all).c_str(),
                      digits(exact).c_str());
    if (exact > 0) text += formatted(": error %.2f %%", 100 * std::abs(all / exact - 1));
    return text + "\n";
}
}

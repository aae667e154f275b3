#include "measure/explain/curves.h"

#include <algorithm>

namespace tyndall::ray_drawing {
Interval<double> axis_of(const RayReport& report) {
    constexpr double hardly = 3e-3;
    double end = report.hits || report.steps.empty() ? report.end : report.steps.back().high;
    for (const RayStep& step : report.steps) {
        if (step.to_eye >= hardly) continue;
        end = step.high;
        break;
    }
    if (!(end > 0)) end = 1;
    const double fog = report.steps.empty() ? 0 : report.steps.front().low;
    const double first = report.surfaces.empty() ? fog : std::min(fog, report.surfaces.front().distance);
    return {first > 0.5 * end ? first - 0.05 * (end - first) : 0, end};
}

std::vector<LightState> light_states(const RayReport& report, const LightOnRay& light) {
    std::vector<LightState> states;
    size_t stretch = 0;
    for (const RayStep& step : report.steps) {
        while (stretch + 1 < light.stretches.size() && light.stretches[stretch].high <= step.middle()) ++stretch;
        states.push_back(light.stretches[stretch].state);
    }
    return states;
}

std::vector<size_t> brightest_lights(const RayReport& report, size_t most) {
    std::vector<size_t> all(report.lights.size());
    for (size_t l = 0; l < all.size(); ++l) all[l] = l;
    std::ranges::stable_sort(
        all, [&](size_t a, size_t b) { return luminance(report.lights[a].fog) > luminance(report.lights[b].fog); });
    all.resize(std::min(all.size(), most));
    std::ranges::sort(all);
    return all;
}

double eye_luminance(const RayStep& step, vec3 source) { return luminance(source) * step.to_eye; }

double light_scale(const RayReport& report, double& most) {
    std::vector<std::pair<double, double>> values; // and lengths
    double length = 0;
    for (size_t i = 0; i < report.steps.size(); ++i) {
        const RayStep& step = report.steps[i];
        double value = eye_luminance(step, step.glow);
        for (const LightOnRay& light : report.lights)
            value = std::max(value, eye_luminance(step, light.at[i].scattered));
        values.push_back({value, step.high - step.low}), length += step.high - step.low;
    }
    std::ranges::sort(values);
    most = values.empty() ? 0 : values.back().first;
    double sum = 0;
    for (const auto& [value, part] : values)
        if ((sum += part) >= 0.97 * length && value > 0) return most > 4 * value ? 2 * value : 1.08 * most;
    return most > 0 ? most : 1;
}
}

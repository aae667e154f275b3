#include "scene/shutter.h"

#include "base/gauss_legendre.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// The position in 0..1 up to which the area under a line from a to b is `area`.
double place_in(double a, double b, double area) {
    const double root = std::sqrt(std::max(a * a + 2 * (b - a) * area, 0.0));
    return a + root > 0 ? std::clamp(2 * area / (a + root), 0.0, 1.0) : 0.0;
}

std::vector<float> curve_of(const Shutter& shutter) {
    return shutter.curve.empty() ? std::vector<float>{1, 1} : shutter.curve;
}

// The time by which a share of the exposure has passed.
double time_at(const Shutter& shutter, const std::vector<float>& curve, double share) {
    const size_t stretches = curve.size() - 1;
    const auto area = [&](size_t stretch) { return 0.5 * (curve[stretch] + curve[stretch + 1]); };
    double all = 0;
    for (size_t i = 0; i < stretches; ++i) all += area(i);
    size_t at = 0;
    double before = 0; // area of the stretches passed
    for (; at + 1 < stretches && before + area(at) < share * all; ++at) before += area(at);
    const double place = static_cast<double>(at) + place_in(curve[at], curve[at + 1], share * all - before);
    return shutter.open + (shutter.close - shutter.open) * place / static_cast<double>(stretches);
}

double transmission(const Shutter& shutter, const std::vector<float>& curve, double time) {
    const double stretches = static_cast<double>(curve.size() - 1);
    const double place = stretches * (time - shutter.open) / (shutter.close - shutter.open);
    const size_t at = static_cast<size_t>(std::clamp(place, 0.0, stretches - 1));
    return std::lerp(double{curve[at]}, double{curve[at + 1]}, place - static_cast<double>(at));
}

// Times and weights that integrate over low..high, where what is averaged is smooth.
void add_nodes(const Shutter& shutter, const std::vector<float>& curve, double low, double high,
               std::vector<ExposedTime>& times) {
    if (!(high > low)) return;
    for (const auto& [at, weight] : gauss_legendre(8)) {
        const double time = low + at * (high - low);
        times.push_back({time, weight * (high - low) * transmission(shutter, curve, time)});
    }
}
}

std::vector<double> shutter_times(const Shutter& shutter, int count) {
    const std::vector<float> curve = curve_of(shutter);
    std::vector<double> times;
    for (int k = 0; k < count; ++k) times.push_back(time_at(shutter, curve, (k + 0.5) / count));
    return times;
}

std::vector<std::vector<ExposedTime>> exposed_times(const Shutter& shutter, int count, std::span<const double> breaks) {
    const std::vector<float> curve = curve_of(shutter);
    std::vector<double> all(breaks.begin(), breaks.end());
    for (size_t i = 0; i < curve.size(); ++i)
        all.push_back(
            std::lerp(shutter.open, shutter.close, static_cast<double>(i) / static_cast<double>(curve.size() - 1)));
    std::ranges::sort(all);
    std::vector<std::vector<ExposedTime>> result(static_cast<size_t>(count));
    for (int k = 0; k < count; ++k) {
        std::vector<ExposedTime>& times = result[static_cast<size_t>(k)];
        double from = time_at(shutter, curve, static_cast<double>(k) / count);
        const double to = time_at(shutter, curve, (k + 1.0) / count);
        for (auto next = std::ranges::upper_bound(all, from); next != all.end() && *next < to; from = *next++)
            add_nodes(shutter, curve, from, *next, times);
        add_nodes(shutter, curve, from, to, times);
        double sum = 0;
        for (const ExposedTime& time : times) sum += time.weight;
        for (ExposedTime& time : times) time.weight /= sum;
    }
    return result;
}
}

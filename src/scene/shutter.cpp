#include "scene/shutter.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// The position in 0..1 up to which the area under a line from a to b is `area`.
double place_in(double a, double b, double area) {
    const double root = std::sqrt(std::max(a * a + 2 * (b - a) * area, 0.0));
    return a + root > 0 ? std::clamp(2 * area / (a + root), 0.0, 1.0) : 0.0;
}
}

std::vector<double> shutter_times(const Shutter& shutter, int count) {
    const std::vector<float> flat{1, 1}, &curve = shutter.curve.empty() ? flat : shutter.curve;
    const size_t stretches = curve.size() - 1;
    double all = 0;
    for (size_t i = 0; i < stretches; ++i) all += 0.5 * (curve[i] + curve[i + 1]);

    std::vector<double> times;
    size_t at = 0;
    double before = 0; // area of the segments passed
    for (int k = 0; k < count; ++k) {
        const double wanted = (k + 0.5) / count * all;
        for (double area; at + 1 < stretches && before + (area = 0.5 * (curve[at] + curve[at + 1])) < wanted; ++at)
            before += area;
        const double place = static_cast<double>(at) + place_in(curve[at], curve[at + 1], wanted - before);
        times.push_back(shutter.open + (shutter.close - shutter.open) * place / static_cast<double>(stretches));
    }
    return times;
}
}

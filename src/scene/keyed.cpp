// Evaluation of animated values: step, linear, eased and cubic Hermite (glTF's CUBICSPLINE).
#include "scene/keyed.h"

#include <glm/gtc/quaternion.hpp>

#include <cassert>

namespace tyndall {
namespace {
float between(float a, float b, float share) { return a + share * (b - a); }
vec3 between(vec3 a, vec3 b, float share) { return a + share * (b - a); }
quat between(quat a, quat b, float share) { return glm::slerp(a, b, share); } // along the shorter arc

float unit(float value) { return value; }
vec3 unit(vec3 value) { return value; }
quat unit(quat value) { return glm::normalize(value); }

// Clamps or wraps a time into the range of the keys.
double within(double seconds, double first, double last, bool loop) {
    if (!loop || last <= first) return std::clamp(seconds, first, last);
    const double turns = (seconds - first) / (last - first);
    return first + (turns - std::floor(turns)) * (last - first);
}

// Hermite spline of glTF 2.0, appendix C: tangents are per second.
template<class T> T spline(const T* from, const T* to, float x, float seconds) {
    const float x2 = x * x, x3 = x2 * x;
    return unit((2 * x3 - 3 * x2 + 1) * from[1] + seconds * (x3 - 2 * x2 + x) * from[2] + (3 * x2 - 2 * x3) * to[1] +
                seconds * (x3 - x2) * to[0]);
}
}

template<class T> T Keyed<T>::at(double seconds) const {
    const bool cubic = interpolation == Interpolation::cubic && !times.empty();
    const size_t stride = cubic ? 3 : 1, middle = cubic ? 1 : 0;
    assert(values.size() == std::max<size_t>(times.size(), 1) * stride);
    if (constant()) return values[middle];

    const double t = within(seconds, times.front(), times.back(), loop);
    const auto after = std::upper_bound(times.begin(), times.end(), t, [](double a, float b) { return a < b; });
    if (after == times.begin()) return values[middle];
    const size_t next = after - times.begin(), i = next - 1;
    if (next == times.size() || interpolation == Interpolation::step) return values[i * stride + middle];

    const double length = static_cast<double>(times[next]) - times[i];
    const float x = static_cast<float>((t - times[i]) / length);
    if (cubic) return spline(&values[i * 3], &values[next * 3], x, static_cast<float>(length));
    const float share = interpolation == Interpolation::smooth ? x * x * (3 - 2 * x) : x;
    return between(values[i], values[next], share);
}

template<class T> void add_key_times(const Keyed<T>& keyed, double from, double to, std::vector<double>& times) {
    constexpr double most = 4096;
    if (keyed.constant()) return;
    const double first = keyed.times.front(), period = double{keyed.times.back()} - first;
    const bool repeats = keyed.loop && period > 0;
    const double turns = repeats ? std::ceil((to - from) / period) : 0; // repetitions that begin in that time
    if (!(turns * static_cast<double>(keyed.times.size()) < most)) return;
    const double start = repeats ? period * std::floor((from - first) / period) : 0;
    for (int turn = 0; turn <= static_cast<int>(turns); ++turn)
        for (const float key : keyed.times) {
            const double time = start + turn * period + key;
            if (time > from && time < to) times.push_back(time);
        }
}

template struct Keyed<float>;
template struct Keyed<vec3>;
template struct Keyed<quat>;
template void add_key_times(const Keyed<float>&, double, double, std::vector<double>&);
template void add_key_times(const Keyed<vec3>&, double, double, std::vector<double>&);
}

// A value that may be animated: a constant, or keyframes with an interpolation.
#pragma once
#include "base/math.h"

#include <glm/gtc/quaternion.hpp>

#include <vector>

namespace tyndall {
using glm::quat;

enum class Interpolation { step, linear, smooth, cubic }; // cubic: values hold in-tangent, value, out-tangent (glTF)

// Before the first and after the last key the value holds, unless `loop` repeats the keys.
template<class T> struct Keyed {
    std::vector<float> times; // ascending seconds; empty = constant values[0]
    std::vector<T> values{T{}};
    Interpolation interpolation = Interpolation::linear;
    bool loop = false;

    Keyed() = default;
    Keyed(T value) : values{value} {}
    bool constant() const { return times.size() < 2; }
    T at(double seconds) const;
};

// Appends the times of the keys between two times, repetitions included; none if a loop has thousands of them there.
template<class T> void add_key_times(const Keyed<T>& keyed, double from, double to, std::vector<double>& times);

// Implemented for float, vec3 and quat (spherical interpolation).
extern template struct Keyed<float>;
extern template struct Keyed<vec3>;
extern template struct Keyed<quat>;
extern template void add_key_times(const Keyed<float>&, double, double, std::vector<double>&);
extern template void add_key_times(const Keyed<vec3>&, double, double, std::vector<double>&);
}

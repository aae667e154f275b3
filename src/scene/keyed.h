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

// Implemented for float, vec3 and quat (spherical interpolation).
extern template struct Keyed<float>;
extern template struct Keyed<vec3>;
extern template struct Keyed<quat>;
}

// GLM under short names, and the few geometric types everything shares.
// World space is right-handed, Y up, meters; angles are radians; colors are linear Rec.709.
#pragma once
#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall {
using glm::dmat4, glm::dvec3, glm::ivec2, glm::ivec3, glm::mat3, glm::mat4, glm::vec2, glm::vec3, glm::vec4;

inline constexpr float pi = 3.14159265358979323846f;
inline constexpr float infinity = std::numeric_limits<float>::infinity();

// Points origin + t·direction for 0 <= t <= t_max; direction has unit length.
struct Ray {
    vec3 origin{0};
    vec3 direction{0, 0, -1};
    float t_max = infinity;

    vec3 at(float t) const { return origin + t * direction; }
};

// An interval low..high along a ray, or along each ray of a packet of sixteen; empty if high <= low.
template<class T> struct Interval {
    T low{}, high{};

    bool empty() const { return !(low < high); }
    T length() const { return empty() ? T(0) : high - low; }
};

template<class T> Interval<T> intersection(Interval<T> a, Interval<T> b) {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

// Axis-aligned box; starts empty and grows.
struct Box {
    vec3 low{infinity}, high{-infinity};

    bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
    vec3 center() const { return 0.5f * (low + high); }
    vec3 size() const { return high - low; }
    // Corner 0 to 7.
    vec3 corner(int i) const { return {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}; }
    void grow(vec3 point) { low = glm::min(low, point), high = glm::max(high, point); }
    void grow(const Box& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
};

inline constexpr Box everywhere() { return {vec3(-infinity), vec3(infinity)}; }

// The part of origin + t·direction, low <= t <= high, inside the box; empty for an empty box. The direction may have
// any length, and its components may be zero.
inline Interval<float> clip(const Box& box, vec3 origin, vec3 direction, Interval<float> range) {
    if (box.empty()) return {};
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
            if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return {};
            continue;
        }
        const float inverse = 1 / direction[axis];
        const float a = (box.low[axis] - origin[axis]) * inverse, b = (box.high[axis] - origin[axis]) * inverse;
        range.low = std::max(range.low, std::min(a, b));
        range.high = std::min(range.high, std::max(a, b));
    }
    return range.empty() ? Interval<float>{} : range;
}

inline bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// The smallest axis-aligned box around an affinely transformed box; everywhere() for a box that is not finite.
inline Box transform(const mat4& matrix, const Box& box) {
    if (box.empty()) return box;
    if (!is_finite(box.low) || !is_finite(box.high)) return everywhere();
    Box result;
    for (int i = 0; i < 8; ++i) result.grow(vec3(matrix * vec4(box.corner(i), 1)));
    return result;
}

// The same with unbounded directions left unbounded; of finite boxes slightly different floats. Interval arithmetic per
// axis: 0 · infinity counts as 0, as a zero coefficient means that the axis has no effect.
inline Box transform_box(const mat4& matrix, const Box& box) {
    Box result{vec3(matrix[3]), vec3(matrix[3])};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const float factor = matrix[column][row];
            if (factor == 0) continue;
            const float a = factor * box.low[column], b = factor * box.high[column];
            result.low[row] += std::min(a, b), result.high[row] += std::max(a, b);
        }
    return result;
}

// Two unit vectors that complete `axis` (unit length) to a right-handed orthonormal frame (Duff et al. 2017).
inline void make_frame(vec3 axis, vec3& u, vec3& v) {
    const float sign = std::copysign(1.0f, axis.z), a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    u = vec3(1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
    v = vec3(b, sign + axis.y * axis.y * a, -axis.y);
}

inline float mean_component(vec3 v) { return v.x + ((v.y - v.x) + (v.z - v.x)) / 3; } // exact if all are equal
inline float max_component(vec3 v) { return std::max(v.x, std::max(v.y, v.z)); }
inline double channel_mean(dvec3 v) { return (v.x + v.y + v.z) / 3; }

// Of linear Rec.709.
inline float luminance(vec3 rgb) { return glm::dot(rgb, vec3(0.2126f, 0.7152f, 0.0722f)); }
inline double luminance(dvec3 rgb) { return glm::dot(rgb, dvec3(0.2126, 0.7152, 0.0722)); }
}

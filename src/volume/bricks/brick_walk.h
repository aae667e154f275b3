// Grid traversal along rays (Amanatides & Woo 1987). The state is an integer cell and the distances to its faces; cells
// are never recomputed from a point, so none is skipped or visited twice.
#pragma once
#include "volume/bricks/bricks.h"

#include <type_traits>

namespace tyndall {
// origin + t·direction in local coordinates, with t in world meters, so the direction is not normalized.
struct LocalRay {
    dvec3 origin{0}, direction{0};
};

inline LocalRay local_ray(const BrickPool& pool, const Ray& ray) {
    const glm::dmat3 matrix(pool.world_to_index);
    return {matrix * (dvec3(ray.origin) - dvec3(pool.anchor)) + dvec3(pool.anchor_index),
            matrix * dvec3(ray.direction)};
}

inline LocalRay local_ray(const mat4& world_to_local, const Ray& ray) {
    const dmat4 matrix(world_to_local);
    return {dvec3(matrix * glm::dvec4(ray.origin, 1)), glm::dmat3(matrix) * dvec3(ray.direction)};
}

// The part of `range` inside the box. The direction may have any length, and its components may be zero.
inline Interval<double> clip(const Box& box, const LocalRay& ray, Interval<double> range) {
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.low[axis], high = box.high[axis];
        if (ray.direction[axis] == 0) {
            if (!(ray.origin[axis] >= low && ray.origin[axis] <= high)) return {};
            continue;
        }
        const double inverse = 1 / ray.direction[axis];
        const double a = (low - ray.origin[axis]) * inverse, b = (high - ray.origin[axis]) * inverse;
        range.low = std::max(range.low, std::min(a, b));
        range.high = std::min(range.high, std::max(a, b));
    }
    return range.empty() ? Interval<double>{} : range;
}

// Calls a visitor and returns whether to continue; a void visitor always continues.
template<class Visit, class... Arguments> bool run_visitor(const Visit& visit, Arguments... arguments) {
    if constexpr (std::is_void_v<std::invoke_result_t<Visit, Arguments...>>)
        return visit(arguments...), true;
    else
        return visit(arguments...);
}

// Calls visit(cell, low, high) in order for every cell in first..last, of edge length `edge`, that the ray crosses on
// `range`, until it returns false. `range` must lie inside these cells up to rounding.
template<class Visit>
void walk_cells(const LocalRay& ray, Interval<double> range, double edge, ivec3 first, ivec3 last, const Visit& visit) {
    ivec3 cell, step;
    dvec3 border, across; // t at the next face along each axis, t between faces
    for (int axis = 0; axis < 3; ++axis) {
        const double at = ray.origin[axis] + range.low * ray.direction[axis], direction = ray.direction[axis];
        cell[axis] = std::clamp(static_cast<int>(std::floor(at / edge)), first[axis], last[axis]);
        step[axis] = direction > 0 ? 1 : -1;
        const double to_border = edge * (cell[axis] + (direction > 0)) - at;
        border[axis] = direction == 0 ? infinity : range.low + to_border / direction;
        across[axis] = direction == 0 ? infinity : edge / std::abs(direction);
    }
    for (double low = range.low;;) {
        const double next = std::min(border.x, std::min(border.y, border.z)), high = std::min(next, range.high);
        if (high > low) {
            if (!run_visitor(visit, cell, low, high)) return;
            low = high;
        }
        if (next >= range.high) return;

        // Step across every face at this t: several at once through an edge or corner.
        for (int axis = 0; axis < 3; ++axis) {
            if (border[axis] != next) continue;
            cell[axis] += step[axis], border[axis] += across[axis];
            if (cell[axis] < first[axis] || cell[axis] > last[axis]) return;
        }
    }
}

// Calls visit(brick, index cell, low, high) in order for every nonempty brick until it returns false.
template<class Visit>
void walk_bricks(const BrickPool& pool, const LocalRay& ray, Interval<double> range, const Visit& visit) {
    if (pool.empty()) return;
    range = clip(pool.local_bounds, ray, range);
    if (range.empty()) return;
    walk_cells(ray, range, 8, ivec3(0), pool.size - 1, [&](ivec3 brick, double low, double high) {
        const int64_t cell = (int64_t{brick.x} * pool.size.y + brick.y) * pool.size.z + brick.z;
        return pool.index[cell] == 0 || run_visitor(visit, brick, cell, low, high);
    });
}
}

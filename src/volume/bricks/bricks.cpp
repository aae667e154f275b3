#include "volume/bricks/bricks.h"

#include "base/error.h"
#include "volume/bricks/half.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
namespace {
// The smallest world box around a local box, rounded outward to floats.
Box image(const dmat4& local_to_world, const Box& box) {
    dvec3 low(infinity), high(-infinity);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 upper(corner & 1, corner & 2, corner & 4);
        const dvec3 point(local_to_world * glm::dvec4(glm::mix(box.low, box.high, upper), 1));
        low = glm::min(low, point), high = glm::max(high, point);
    }
    Box result;
    for (int axis = 0; axis < 3; ++axis) {
        result.low[axis] = std::nextafter(static_cast<float>(low[axis]), -infinity);
        result.high[axis] = std::nextafter(static_cast<float>(high[axis]), infinity);
    }
    return result;
}

bool is_finite(const mat4& m) {
    return tyndall::is_finite(vec3(m[0])) && tyndall::is_finite(vec3(m[1])) && tyndall::is_finite(vec3(m[2])) &&
           tyndall::is_finite(vec3(m[3]));
}

float lerp(float a, float b, float weight) { return std::fma(b - a, weight, a); }
}

uint64_t BrickPool::bytes() const {
    return index.size() * sizeof(int32_t) + values.size() * sizeof(uint16_t) +
           (constants.size() + minimum.size() + maximum.size()) * sizeof(float);
}

void place(BrickPool& pool, const dmat4& index_to_world) {
    const dmat4 local_to_world = glm::translate(index_to_world, dvec3(pool.low));
    const dmat4 world_to_local = glm::inverse(local_to_world);
    pool.index_to_world = mat4(local_to_world);
    pool.world_to_index = mat4(world_to_local);
    if (!is_finite(pool.index_to_world) || !is_finite(pool.world_to_index))
        refuse("fog transform", "is singular or out of range; no axis may have zero scale");
    for (int axis = 0; axis < 3; ++axis)
        pool.voxel_size[axis] = static_cast<float>(glm::length(dvec3(index_to_world[axis])));
    if (pool.empty()) return;

    // The anchor is a world point exactly representable in floats; its local coordinates are computed in double.
    pool.bounds = image(local_to_world, pool.local_bounds);
    pool.anchor = vec3(local_to_world * glm::dvec4(pool.local_bounds.center(), 1));
    pool.anchor_index = vec3(world_to_local * glm::dvec4(pool.anchor, 1));
    const dvec3 extent(dvec3(pool.bounds.high) - dvec3(pool.bounds.low));
    const double world_volume = std::abs(glm::determinant(glm::dmat3(index_to_world)));
    pool.mean = static_cast<float>(pool.mass * world_volume / (extent.x * extent.y * extent.z));
}

vec3 local_point(const BrickPool& pool, vec3 world_point) {
    const vec3 p = world_point - pool.anchor;
    vec3 local = pool.anchor_index;
    for (int axis = 0; axis < 3; ++axis)
        for (int column = 0; column < 3; ++column)
            local[axis] = std::fma(p[column], pool.world_to_index[column][axis], local[axis]);
    return local;
}

float sample_density(const BrickPool& pool, vec3 world_point) {
    if (pool.empty()) return 0;
    const vec3 local = local_point(pool, world_point);
    int cell[3];
    float weight[3];
    for (int axis = 0; axis < 3; ++axis) {
        const float inside = std::min(local[axis] > 0 ? local[axis] : 0.0f, 8.0f * pool.size[axis] - 1);
        cell[axis] = static_cast<int>(inside);
        weight[axis] = inside - static_cast<float>(cell[axis]);
    }

    const int brick = ((cell[0] / 8) * pool.size.y + cell[1] / 8) * pool.size.z + cell[2] / 8;
    const int32_t id = pool.index[brick];
    if (id <= 0) return id == 0 ? 0 : pool.constants[-id - 1];

    const uint16_t* corner =
        pool.values.data() + size_t(id - 1) * brick_stride + (cell[0] % 8) * 81 + (cell[1] % 8) * 9 + cell[2] % 8;
    const auto along_z = [&](int offset) {
        return lerp(float_from_half(corner[offset]), float_from_half(corner[offset + 1]), weight[2]);
    };
    return lerp(lerp(along_z(0), along_z(9), weight[1]), lerp(along_z(81), along_z(90), weight[1]), weight[0]);
}
}

// Fog grids made in memory, and the plainest possible look at them.
#pragma once
#include "base/random.h"
#include "trace/small_scenes.h"
#include "volume/bricks/bricks.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

namespace tyndall::test {
using VoxelFunction = std::function<float(int, int, int)>;

// Leaves with the value of every voxel of the box; zero outside. Leaves of zeros are kept.
inline SparseVolume volume_of(ivec3 low, ivec3 high, const VoxelFunction& value) {
    SparseVolume volume;
    volume.active_low = low, volume.active_high = high;
    const ivec3 first((low.x >> 3) * 8, (low.y >> 3) * 8, (low.z >> 3) * 8);
    for (int x = first.x; x <= high.x; x += 8)
        for (int y = first.y; y <= high.y; y += 8)
            for (int z = first.z; z <= high.z; z += 8) {
                Leaf leaf{ivec3(x, y, z), {}};
                for (int v = 0; v < 512; ++v) {
                    const ivec3 at = leaf.origin + ivec3(v >> 6, (v >> 3) & 7, v & 7);
                    const bool inside =
                        glm::all(glm::greaterThanEqual(at, low)) && glm::all(glm::lessThanEqual(at, high));
                    if (inside) leaf.values[v] = value(at.x, at.y, at.z);
                }
                volume.leaves.push_back(leaf);
            }
    return volume;
}

inline SparseVolume constant_box(int size, float value) {
    return volume_of(ivec3(0), ivec3(size - 1), [&](int, int, int) { return value; });
}

// Multiples of 1/256: halves hold them exactly.
inline float exact_noise(int x, int y, int z) {
    return static_cast<float>(hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(z)) %
                              257) /
           256;
}

// The medium in another place.
inline Medium placed(Medium medium, const mat4& local_to_world) {
    medium.density.world_to_local = glm::inverse(local_to_world);
    medium.world_bounds = transform(local_to_world, medium.density.bounds);
    return medium;
}

inline Medium height_fog(float extinction, float base, float falloff, Box bounds = everywhere()) {
    Medium medium = homogeneous_medium(extinction, bounds);
    medium.density.kind = DensityKind::height;
    medium.density.height_base = base, medium.density.height_falloff = falloff;
    return medium;
}

// Every voxel that is not 0, and trilinear sampling by definition, in double.
class VoxelMap {
public:
    explicit VoxelMap(const SparseVolume& volume) {
        for (const Leaf& leaf : volume.leaves)
            for (int v = 0; v < 512; ++v) add(leaf.origin + ivec3(v >> 6, (v >> 3) & 7, v & 7), leaf.values[v]);
        for (const Tile& tile : volume.tiles)
            for (int x = tile.low.x; x <= tile.high.x; ++x)
                for (int y = tile.low.y; y <= tile.high.y; ++y)
                    for (int z = tile.low.z; z <= tile.high.z; ++z) add(ivec3(x, y, z), tile.value);
    }

    double sample(dvec3 index_point) const {
        const dvec3 low = glm::floor(index_point), w = index_point - low;
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const ivec3 d(corner >> 2, (corner >> 1) & 1, corner & 1);
            const double weight = (d.x ? w.x : 1 - w.x) * (d.y ? w.y : 1 - w.y) * (d.z ? w.z : 1 - w.z);
            sum += weight * at(ivec3(low) + d);
        }
        return sum;
    }

    float at(ivec3 voxel) const {
        const auto found = values_.find({voxel.x, voxel.y, voxel.z});
        return found == values_.end() ? 0 : found->second;
    }

    double sum() const {
        double total = 0;
        for (const auto& [voxel, value] : values_) total += value;
        return total;
    }

private:
    void add(ivec3 voxel, float value) {
        if (value != 0) values_[{voxel.x, voxel.y, voxel.z}] = value;
    }
    std::map<std::array<int, 3>, float> values_;
};

// A random number in low..high; `use` tells the numbers of one test apart.
inline float random_in(float low, float high, uint32_t index, uint32_t use) {
    return low + (high - low) * random_unit(index, use, 0, 99);
}
inline vec3 random_point(vec3 low, vec3 high, uint32_t index, uint32_t use) {
    return {random_in(low.x, high.x, index, 3 * use), random_in(low.y, high.y, index, 3 * use + 1),
            random_in(low.z, high.z, index, 3 * use + 2)};
}

// The ray from one point to another.
inline Ray ray_between(vec3 from, vec3 to) {
    const vec3 way = to - from;
    return {from, glm::normalize(way), glm::length(way)};
}
}

#include "volume/motion/velocity_field.h"

#include "base/parallel.h"
#include "volume/bricks/bricks.h"
#include "volume/motion/cell_grid.h"

#include <algorithm>
#include <map>

namespace tyndall {
namespace {
constexpr float min_share = 1e-3f; // minimum share of the interpolation weight on known voxels
constexpr size_t joint_stride = 9 * 9 * 9, max_joint_bytes = size_t{1} << 29;

// Smallest and largest known value; `volume` and `known` have the same leaves and tiles.
Interval<float> range_of(const SparseVolume& volume, const SparseVolume& known) {
    Interval<float> range{infinity, -infinity};
    const auto add = [&](float value) { range = {std::min(range.low, value), std::max(range.high, value)}; };
    for (size_t n = 0; n < volume.leaves.size(); ++n)
        for (size_t v = 0; v < 512; ++v)
            if (known.leaves[n].values[v] > 0) add(volume.leaves[n].values[v]);
    for (const Tile& tile : volume.tiles) add(tile.value);
    return range;
}

// Maps values to 0..1, where halves resolve at least a 4096th of the range.
void normalize(const SparseVolume& known, float low, float range, SparseVolume& volume) {
    const auto normal = [&](float value) { return range > 0 ? (value - low) / range : 0.0f; };
    parallel_ranges(static_cast<int64_t>(volume.leaves.size()), 64, [&](int64_t begin, int64_t end) {
        for (auto n = static_cast<size_t>(begin); n < static_cast<size_t>(end); ++n)
            for (size_t v = 0; v < 512; ++v) {
                float& value = volume.leaves[n].values[v];
                value = known.leaves[n].values[v] > 0 ? normal(value) : 0;
            }
    });
    for (Tile& tile : volume.tiles) tile.value = normal(tile.value);
}

// A copy of the bricks with another transform.
std::shared_ptr<const BrickPool> placed(const BrickPool& pool, const dmat4& index_to_world) {
    auto moved = std::make_shared<BrickPool>(pool);
    place(*moved, index_to_world);
    return moved;
}

// Null unless all three components are known at the same voxels, or if they would take more than half a gigabyte.
std::shared_ptr<const JointBricks> joint_bricks(const VelocityField& field) {
    if (field.any) return nullptr;
    for (size_t c = 0; c < 3; ++c)
        if (!field.known[c] || field.known[c] != field.known[0] || field.index_to_world[c] != field.index_to_world[0])
            return nullptr;
    const auto known = placed(*field.known[0], dmat4(1));
    const std::shared_ptr<const BrickPool> components[] = {placed(*field.components[0], dmat4(1)),
                                                           placed(*field.components[1], dmat4(1)),
                                                           placed(*field.components[2], dmat4(1))};
    auto joint = std::make_shared<JointBricks>();
    std::vector<ivec3> cells;
    size_t at = 0;
    for_each_cell(ivec3(0), known->size - 1, [&](ivec3 cell) {
        const bool filled = known->index[at++] != 0;
        if (filled) cells.push_back(known->low + 8 * cell);
        joint->index.push_back(filled ? static_cast<int32_t>(cells.size()) : 0);
    });
    if (cells.size() * joint_stride * sizeof(vec4) > max_joint_bytes) return nullptr;
    joint->values.resize(cells.size() * joint_stride);
    parallel_ranges(static_cast<int64_t>(cells.size()), 16, [&](int64_t begin, int64_t end) {
        for (auto n = static_cast<size_t>(begin); n < static_cast<size_t>(end); ++n)
            for (size_t v = 0; v < joint_stride; ++v) {
                const vec3 voxel(cells[n] + ivec3(v / 81, v / 9 % 9, v % 9));
                joint->values[n * joint_stride + v] = {
                    sample_density(*known, voxel), sample_density(*components[0], voxel),
                    sample_density(*components[1], voxel), sample_density(*components[2], voxel)};
            }
    });
    return joint;
}
}

VelocityField make_velocity_field(VelocityVolume volume) {
    VelocityField field;
    if (std::ranges::all_of(volume.components, &SparseVolume::empty)) return field;
    vec3 greatest(0);
    std::shared_ptr<const BrickPool> known;
    for (size_t c = 0; c < 3; ++c) {
        SparseVolume& component = volume.components[c];
        if (component.empty()) continue;
        const SparseVolume& mask = volume.known[volume.known.size() == 3 ? c : 0];
        const Interval<float> range = range_of(component, mask);
        const auto axis = static_cast<glm::length_t>(c);
        field.low[axis] = range.low, field.range[axis] = range.high - range.low;
        greatest[axis] = std::max(std::abs(range.low), std::abs(range.high));
        field.index_to_world[c] = component.index_to_world;
        normalize(mask, range.low, range.high - range.low, component);
        if (!known || volume.known.size() == 3) known = make_bricks(mask);
        field.components[c] = make_bricks(component), field.known[c] = known;
    }
    if (!volume.any.empty()) field.any = make_bricks(volume.any), field.any_to_world = volume.any.index_to_world;
    field.fastest = glm::length(greatest);
    field.joint = joint_bricks(field);
    return field;
}

LocalVelocity::LocalVelocity(const VelocityField& field, const dmat4& index_to_world)
    : joint_(field.joint), low_(field.low), range_(field.range), to_index_(glm::inverse(glm::dmat3(index_to_world))) {
    const dmat4 to_index = glm::inverse(index_to_world);
    if (field.any) any_ = placed(*field.any, to_index * field.any_to_world);
    for (size_t c = 0; c < 3; ++c) {
        if (!field.known[c]) continue;
        const dmat4 place = to_index * field.index_to_world[c];
        components_[c] = placed(*field.components[c], place);
        const bool same =
            c > 0 && field.known[c] == field.known[0] && field.index_to_world[c] == field.index_to_world[0];
        known_[c] = same ? known_[0] : placed(*field.known[c], place);
    }
}

vec4 LocalVelocity::joint_at(vec3 point) const {
    const BrickPool& pool = *known_[0];
    vec3 local = local_point(pool, point);
    for (int axis = 0; axis < 3; ++axis) // not a number becomes 0
        local[axis] = std::min(local[axis] > 0 ? local[axis] : 0.0f, 8.0f * static_cast<float>(pool.size[axis]) - 1);
    const ivec3 cell(local), brick = cell / 8, voxel = cell % 8;
    const int32_t id = joint_->index[static_cast<size_t>((brick.x * pool.size.y + brick.y) * pool.size.z + brick.z)];
    if (id == 0) return vec4(0);
    const vec4* corner = &joint_->values[static_cast<size_t>(id - 1) * joint_stride +
                                         static_cast<size_t>(voxel.x * 81 + voxel.y * 9 + voxel.z)];
    const vec3 weight = local - vec3(cell);
    const auto along_z = [&](int offset) { return glm::mix(corner[offset], corner[offset + 1], weight.z); };
    return glm::mix(glm::mix(along_z(0), along_z(9), weight.y), glm::mix(along_z(81), along_z(90), weight.y), weight.x);
}

bool LocalVelocity::at(vec3 point, vec3& velocity) const {
    if (joint_) {
        const vec4 joint = joint_at(point);
        if (!(joint.x > min_share)) return false;
        velocity = to_index_ * (low_ + range_ * (vec3(joint.y, joint.z, joint.w) / joint.x));
        return true;
    }
    vec3 share(infinity);
    for (glm::length_t c = 0; c < 3; ++c) {
        const auto i = static_cast<size_t>(c);
        if (known_[i]) share[c] = c > 0 && known_[i] == known_[0] ? share[0] : sample_density(*known_[i], point);
    }
    const float all = any_ ? sample_density(*any_, point) : glm::min(share.x, glm::min(share.y, share.z));
    if (!(all > min_share)) return false;
    vec3 in_world(0);
    for (glm::length_t c = 0; c < 3; ++c) {
        const auto i = static_cast<size_t>(c);
        if (!known_[i] || !(share[c] > 0)) continue;
        const float part = range_[c] > 0 ? sample_density(*components_[i], point) / share[c] : 0;
        in_world[c] = low_[c] + range_[c] * part;
        if (any_) in_world[c] *= share[c] / all;
    }
    velocity = to_index_ * in_world;
    return true;
}
}

// Integrates fog along the columns of a light's grid, sixteen columns at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/transmittance/light_grid_fill.cpp"
#include <hwy/foreach_target.h>

#include "base/parallel.h"
#include "trace/transmittance/light_grid.h"

#include "volume/medium_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
constexpr float voxels_per_sample = 1.5f;

// World points of sixteen columns: origin + w·direction.
struct Columns {
    Vec3s origin, direction;
};

// Direction of an octahedral coordinate in grid axes, not normalized.
vec3 octahedral_direction(float x, float y) {
    const float z = 1 - std::abs(x) - std::abs(y);
    if (z >= 0) return {x, y, z};
    return {(1 - std::abs(y)) * (x < 0 ? -1.0f : 1.0f), (1 - std::abs(x)) * (y < 0 ? -1.0f : 1.0f), z};
}

Columns columns_at(const LightDepthGrid& grid, int first, int row) {
    alignas(64) float v[6][16];
    const mat3 grid_to_world = glm::transpose(grid.world_to_grid);
    for (int lane = 0; lane < 16; ++lane) {
        const int column = std::min(first + lane, grid.size.x - 1);
        const float x = (static_cast<float>(column) - grid.offset.x) / grid.scale.x;
        const float y = (static_cast<float>(row) - grid.offset.y) / grid.scale.y;
        vec3 origin(0), direction(0, 0, 1);
        if (grid.projection == LightProjection::parallel) origin = vec3(x, y, 0);
        if (grid.projection == LightProjection::perspective) direction = glm::normalize(vec3(x, y, 1));
        if (grid.projection == LightProjection::all_around) direction = glm::normalize(octahedral_direction(x, y));
        origin = grid.position + grid_to_world * origin;
        direction = grid_to_world * direction;
        for (int axis = 0; axis < 3; ++axis) v[axis][lane] = origin[axis], v[3 + axis][lane] = direction[axis];
    }
    return {{load(v[0]), load(v[1]), load(v[2])}, {load(v[3]), load(v[4]), load(v[5])}};
}

// Optical depth of one medium between two distances along the columns, by the midpoint rule.
Floats depth_between(const Medium& medium, const Columns& columns, float from, float to) {
    if (!(to > from)) return 0.0f;
    const vec3 voxel = medium.density.bricks->voxel_size;
    const float finest = std::min(voxel.x, std::min(voxel.y, voxel.z));
    const int samples = std::max(1, static_cast<int>(std::ceil((to - from) / (voxels_per_sample * finest))));
    const float step = (to - from) / static_cast<float>(samples);
    Floats sum = 0.0f;
    for (int i = 0; i < samples; ++i) {
        const float w = from + (static_cast<float>(i) + 0.5f) * step;
        sum = sum + density16(medium, fma(columns.direction, w, columns.origin));
    }
    return sum * (step * gray_extinction(medium.optics));
}

void fill_columns(std::span<const Medium* const> media, int first, int row, const LightDepthGrid& grid,
                  std::vector<float>& depths) {
    const Columns columns = columns_at(grid, first, row);
    const size_t count = static_cast<size_t>(std::min(16, grid.size.x - first));
    const auto distance = [&](int k) {
        return std::max((static_cast<float>(k) - grid.offset.z) / grid.scale.z, grid.start);
    };
    Floats sum = 0.0f;
    for (int k = 0; k < grid.size.z; ++k) {
        if (k > 0)
            for (const Medium* medium : media)
                sum = sum + depth_between(*medium, columns, distance(k - 1), distance(k));
        alignas(64) float depth[16];
        store(sum, depth);
        const size_t at = (static_cast<size_t>(k) * grid.size.y + row) * grid.size.x + first;
        std::copy_n(depth, count, depths.begin() + static_cast<int64_t>(at));
    }
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fill_columns);
GridColumns::GridColumns(std::vector<const Medium*> media, LightDepthGrid& grid)
    : media_(std::move(media)), grid_(grid),
      depths_(std::make_shared<std::vector<float>>(static_cast<size_t>(grid.size.x) * grid.size.y * grid.size.z)),
      states_(std::make_unique<std::atomic<uint8_t>[]>(static_cast<size_t>(packets_across()) * grid.size.y)) {
    grid_.depth = grid.depth = depths_;
}

void GridColumns::fill(int packet) const {
    std::atomic<uint8_t>& state = states_[static_cast<size_t>(packet)];
    uint8_t expected = untouched;
    if (state.compare_exchange_strong(expected, at_work)) {
        const int first = packet % packets_across() * 16, row = packet / packets_across();
        HWY_DYNAMIC_DISPATCH(fill_columns)(media_, first, row, grid_, *depths_);
        state.store(done, std::memory_order_release), state.notify_all();
        return;
    }
    while ((expected = state.load(std::memory_order_acquire)) != done) state.wait(expected);
}

void fill_grid(std::span<const Medium* const> media, LightDepthGrid& grid) {
    std::vector<float> depths(static_cast<size_t>(grid.size.x) * grid.size.y * grid.size.z, 0.0f);
    const int packets = (grid.size.x + 15) / 16;
    parallel_for(int64_t{packets} * grid.size.y, [&](int64_t i) {
        const int first = static_cast<int>(i % packets) * 16, row = static_cast<int>(i / packets);
        HWY_DYNAMIC_DISPATCH(fill_columns)(media, first, row, grid, depths);
    });
    grid.depth = std::make_shared<const std::vector<float>>(std::move(depths));
}
}
#endif

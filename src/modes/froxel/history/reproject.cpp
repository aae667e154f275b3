// Resamples the last frame's froxels at this frame's: 16 slices of a tile at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel/history/reproject.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel/history/froxel_history.h"

#include "base/parallel.h"
#include "modes/froxel/lookup/place_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
using FroxelTag = hn::CappedTag<float, 4>;
constexpr size_t froxel_lanes = hn::MaxLanes(FroxelTag()), froxel_parts = 4 / froxel_lanes;

// Positions of 16 froxel centers in the last frame's grid: cells of tiles, slices in front and behind, and
// interpolation weights. `known` is 0 outside.
struct HistoryTaps {
    alignas(64) int32_t tile[16], near[16], step[16];
    alignas(64) float x[16], y[16], depth[16], known[16];
};

struct Reprojector {
    const FroxelHistory& memory;
    const FroxelGrid& grid;
    const FroxelTiles& tiles;
    Reprojection& result;
    std::vector<float> centers; // planar depths of the centers of the last frame's slices
};

// Pixels of points in the last frame's image (as project()).
HWY_INLINE Vec3s projected(const FroxelGrid& grid, const Vec3s& point) {
    const Camera& camera = grid.camera;
    const Vec3s offset = point - splat(camera.position);
    const Floats z = dot(offset, splat(camera.forward));
    const bool ortho = camera.ortho_height > 0;
    const float scale = static_cast<float>(grid.image_size.y) / view_height(camera);
    const Floats per_meter = ortho ? Floats(scale) : Floats(scale) / select(z > 0.0f, z, 1.0f);
    return {fma(dot(offset, splat(camera.right)), per_meter, 0.5f * static_cast<float>(grid.image_size.x)),
            fma(-dot(offset, splat(camera.up)), per_meter, 0.5f * static_cast<float>(grid.image_size.y)), z};
}

void find(const Reprojector& reproject, const Vec3s& points, HistoryTaps& found) {
    const FroxelGrid& grid = reproject.memory.grid;
    const Vec3s place = projected(grid, points);
    const float per_tile = 1 / static_cast<float>(grid.tile);
    const Floats x = fma(place.x, per_tile, 0.5f), y = fma(place.y, per_tile, 0.5f);
    const float right = static_cast<float>(grid.size.x - 1), bottom = static_cast<float>(grid.size.y - 1);
    constexpr float slack = 1e-3f; // of a tile: includes the outermost tile centers
    const Mask16 inside = (x >= -slack) & (y >= -slack) & (x <= right + slack) & (y <= bottom + slack) &
                          (place.z >= grid.faces.front()) & (place.z <= grid.faces.back()) & (place.z > 0.0f);
    const Floats held_x = max(min(zero_unless(inside, x), right), 0.0f);
    const Floats held_y = max(min(zero_unless(inside, y), bottom), 0.0f);
    const Ints column = min(truncate(held_x), Ints(grid.size.x - 2)),
               row = min(truncate(held_y), Ints(grid.size.y - 2));

    // Interpolates between the centers of two slices.
    const Floats z = select(inside, place.z, grid.faces.front());
    const Ints slice = slices_of(grid, z);
    const Mask16 before = z < gather(reproject.centers.data(), slice);
    const Ints one = truncate(select(before, 1.0f, 0.0f));
    const Ints near = max(slice - one, 0), far = min(slice - one + Ints(1), grid.slices() - 1);
    const Floats low = gather(reproject.centers.data(), near), high = gather(reproject.centers.data(), far);
    const Mask16 apart = high > low;
    const Floats share = (z - low) / select(apart, high - low, 1.0f);
    store(zero_unless(apart, max(min(share, 1.0f), 0.0f)), found.depth);
    store(row * grid.size.x + column, found.tile), store(near, found.near), store(far - near, found.step);
    store(held_x - to_floats(column), found.x), store(held_y - to_floats(row), found.y);
    store(select(inside, 1.0f, 0.0f), found.known);
}

// Trilinear mean of the known neighbors; zeros where too few are known.
HWY_INLINE void mix(const Reprojector& reproject, const HistoryTaps& found, size_t lane, float* result) {
    constexpr float least = 0.3f; // minimum weight of known neighbors
    const FroxelTag tag;
    const FroxelGrid& grid = reproject.memory.grid;
    const size_t tile = static_cast<size_t>(found.tile[lane]), row = static_cast<size_t>(grid.size.x);
    const size_t tiles[] = {tile, tile + 1, tile + row, tile + row + 1};
    const float x = found.x[lane], y = found.y[lane], depth = found.depth[lane];
    const float across[] = {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
    hn::Vec<FroxelTag> sum[froxel_parts], known[froxel_parts];
    for (size_t p = 0; p < froxel_parts; ++p) sum[p] = known[p] = hn::Zero(tag);
    const size_t step = 4 * static_cast<size_t>(found.step[lane]);
    for (size_t i = 0; i < 4; ++i) {
        const float* from = reproject.memory.light.at(grid, tiles[i], found.near[lane]);
        for (const auto& [at, share] : {std::pair{from, 1 - depth}, std::pair{from + step, depth}})
            for (size_t p = 0; p < froxel_parts; ++p) {
                const auto light = hn::LoadU(tag, at + p * froxel_lanes), weight = hn::Set(tag, across[i] * share);
                sum[p] = hn::MulAdd(weight, light, sum[p]);
                known[p] = hn::Add(known[p], hn::IfThenElseZero(hn::Gt(light, hn::Zero(tag)), weight));
            }
    }
    alignas(16) float total[4], there[4];
    for (size_t p = 0; p < froxel_parts; ++p)
        hn::Store(sum[p], tag, total + p * froxel_lanes), hn::Store(known[p], tag, there + p * froxel_lanes);
    const float extinctions = there[3];
    const bool enough = extinctions > least && std::isfinite(total[0] + total[1] + total[2] + total[3]);
    for (size_t c = 0; c < 4; ++c) result[c] = enough ? total[c] / extinctions : 0;
}

void reproject_tile(const Reprojector& reproject, ivec2 at) {
    const FroxelGrid& grid = reproject.grid;
    const size_t tile = grid.tile_index(at), slices = static_cast<size_t>(grid.slices());
    float* result = reproject.result.light.at(grid, tile, 0);
    const vec2 pixel = grid.pixel_of(vec2(at));
    const vec3 origin = grid.origin + pixel.x * grid.origin_x + pixel.y * grid.origin_y, step = grid.line_step(pixel);
    const size_t seen = seen_slices(grid, reproject.tiles, tile);
    float blur = 0, known = 0;
    for (size_t first = 0; first < seen; first += 16) {
        alignas(64) float z[16];
        for (size_t i = 0; i < 16; ++i) {
            const size_t k = std::min(first + i, seen - 1);
            z[i] = 0.5f * (grid.faces[k] + grid.faces[k + 1]);
        }
        HistoryTaps found;
        find(reproject, fma(splat(step), load(z), splat(origin)), found);
        for (size_t i = 0; i < std::min<size_t>(16, seen - first); ++i)
            if (found.known[i] > 0) {
                mix(reproject, found, i, result + 4 * (first + i));
                // Variance of linear interpolation between two neighbors.
                for (const float share : {found.x[i], found.y[i], found.depth[i]}) blur += share * (1 - share);
                ++known;
            } else
                std::fill_n(result + 4 * (first + i), 4, 0.0f);
    }
    reproject.result.blur[tile] = known > 0 ? blur / known : 0;
    std::fill(result + 4 * seen, result + 4 * slices, 0.0f);
}

void reproject_kernel(const FroxelHistory& memory, const FroxelGrid& grid, const FroxelTiles& tiles,
                      Reprojection& result) {
    Reprojector reproject{memory, grid, tiles, result, {}};
    for (size_t k = 0; k + 1 < memory.grid.faces.size(); ++k)
        reproject.centers.push_back(0.5f * (memory.grid.faces[k] + memory.grid.faces[k + 1]));
    parallel_for(grid.size.y, [&](int64_t y) {
        for (int x = 0; x < grid.size.x; ++x) reproject_tile(reproject, {x, static_cast<int>(y)});
    });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(reproject_kernel);
Reprojection reproject(const FroxelHistory& memory, const FroxelGrid& grid, const FroxelTiles& tiles) {
    Reprojection result;
    result.light.values.resize(4 * grid.tiles() * static_cast<size_t>(grid.slices()));
    result.blur.resize(grid.tiles());
    HWY_DYNAMIC_DISPATCH(reproject_kernel)(memory, grid, tiles, result);
    return result;
}
}
#endif

// Clamps the history to each froxel's neighborhood in this frame and blends the two: four froxels of a tile at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "modes/froxel/history/blend.cpp"
#include <hwy/foreach_target.h>

#include "modes/froxel/history/froxel_history.h"

#include "base/parallel.h"
#include "modes/froxel/history/quads_simd.h"
#include "modes/froxel/lookup/integrate_simd.h"

#include <array>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
constexpr ivec2 block_size{16, 8}; // tiles
constexpr float max_blur = 0.1f;   // froxels²: moving detail is blurred by a third of a froxel

// Minimum and maximum over each froxel of a tile and its neighbors in depth; low > high where there are none. For
// light, only froxels filled in this frame that contain fog count. Padded by one froxel at either end.
struct Bounds {
    RecycledFloats low, high;
    size_t stride = 0; // of a tile

    void resize(size_t tiles, size_t values) {
        stride = (values + 15) / 16 * 16 + 32;
        low.resize(tiles * stride), high.resize(tiles * stride);
    }
};

struct Blend {
    const FroxelGrid& grid;
    const FroxelTiles& tiles;
    const FroxelLight& now;
    const BlendPass& pass;
    FroxelLight& light; // the history, then the blend
    FroxelSums& sums;

    const uint8_t* stale_at(size_t tile, size_t first) const {
        return pass.stale ? pass.stale + tile * static_cast<size_t>(grid.slices()) + first / 4 : nullptr;
    }
    // Whether all visible froxels of a tile are stale, extinction included.
    bool stands(size_t tile) const {
        return pass.statics && pass.stale && !std::memchr(stale_at(tile, 0), 0, seen(tile) / 4);
    }
    // Weight of the history. A history of weight w that every frame blurs by a variance v has a variance of v w/(1 -
    // w).
    float weight_of(size_t tile) const {
        const float blur = pass.blur.empty() ? 0 : pass.blur[tile];
        return std::min(pass.weight, max_blur / (max_blur + blur));
    }
    // Number of values of a tile's visible froxels.
    size_t seen(size_t tile) const { return 4 * size_t{slices[tile]}; }

    std::vector<uint32_t> slices{}; // visible, per tile
};

void find_bounds(const Blend& blend, size_t tile, float* low, float* high) {
    static thread_local RecycledFloats least, most;
    const size_t count = blend.seen(tile), padded = (count + 15) / 16 * 16;
    least.resize(padded + 32), most.resize(padded + 32);
    const auto clear = [&](size_t at) HWY_ATTR { store(infinity, &least[at]), store(-infinity, &most[at]); };
    clear(0), clear(padded + 16);
    const float* light = blend.now.at(blend.grid, tile, 0);
    const Mask16 is_extinction = extinction_lanes();
    for (size_t i = 0; i < count; i += 16) {
        const size_t here = std::min<size_t>(16, count - i);
        const Floats values = load_some(light + i, here);
        Mask16 valid = (extinctions(values) > 0.0f) & (finite_sums(values) <= 0.0f);
        if (blend.pass.stale) valid = valid & !stale_lanes(blend.stale_at(tile, i), here);
        valid = valid | is_extinction;
        store(select(valid, values, infinity), &least[16 + i]), store(select(valid, values, -infinity), &most[16 + i]);
    }
    if (count < padded)
        for (size_t i = count; i < padded; ++i) least[16 + i] = infinity, most[16 + i] = -infinity;
    for (size_t i = 0; i < padded + 16; i += 16) {
        const float *a = &least[i + 12], *b = &most[i + 12]; // one slice before
        if (i == padded) {
            store(infinity, low + i), store(-infinity, high + i);
            for (size_t c = 0; c < 4; ++c) low[i + c] = a[c], high[i + c] = b[c];
            continue;
        }
        store(min(min(load(a), load(a + 4)), load(a + 8)), low + i);
        store(max(max(load(b), load(b + 4)), load(b + 8)), high + i);
    }
}

// Bounds of a tile, or of tiles in a column, and the number of values that are set.
struct Column {
    const float *low = nullptr, *high = nullptr;
    size_t reach = 0; // values
};

// Merges the bounds of up to three rows.
struct Joined {
    RecycledFloats low, high;

    Column join(std::span<const Column> rows, size_t stride) {
        if (rows.empty()) return {};
        if (rows.size() == 1) return rows[0];
        low.resize(stride), high.resize(stride);
        size_t reach = 0;
        for (const Column& row : rows) {
            for (size_t i = 0; i < row.reach; i += 16) {
                const bool fresh = i >= reach;
                store(fresh ? load(row.low + i) : min(load(&low[i]), load(row.low + i)), &low[i]);
                store(fresh ? load(row.high + i) : max(load(&high[i]), load(row.high + i)), &high[i]);
            }
            reach = std::max(reach, (row.reach + 15) / 16 * 16);
        }
        return {low.data(), high.data(), reach};
    }
};

// Zeroes froxels without fog or with light that is not finite.
void forget_unknown(float* light, size_t count) {
    for (size_t i = 0; i < count; i += 16) {
        const size_t here = std::min<size_t>(16, count - i);
        const Floats values = load_some(light + i, here);
        const Mask16 known = (extinctions(values) > 0.0f) & (finite_sums(values) <= 0.0f);
        if (!any(!known)) continue;
        store_some(zero_unless(known, values), here, light + i);
    }
}

void blend_tile(const Blend& blend, std::span<const Column> columns, size_t tile) {
    const size_t count = blend.seen(tile);
    float* light = blend.light.at(blend.grid, tile, 0);
    const float* now = blend.stands(tile) ? light : blend.now.at(blend.grid, tile, 0);
    const Mask16 is_extinction = extinction_lanes();
    const float weight = blend.weight_of(tile);
    for (size_t i = 0; i < count; i += 16) {
        const size_t here = std::min<size_t>(16, count - i);
        Floats low = infinity, high = -infinity;
        for (const Column& column : columns)
            if (i < column.reach) low = min(low, load(column.low + i)), high = max(high, load(column.high + i));
        const Floats was = load_some(light + i, here), is = load_some(now + i, here);
        Floats kept = select(low <= high, max(low, min(was, high)), was);
        if (blend.pass.statics) kept = select(is_extinction, was, kept); // no new extinction to clamp to
        Floats mixed = is + (kept - is) * weight;
        if (blend.pass.stale) {
            const Mask16 stale = stale_lanes(blend.stale_at(tile, i), here);
            mixed = select(blend.pass.statics ? stale : stale & !is_extinction, kept, mixed);
        }
        mixed = select(extinctions(was) > 0.0f, mixed, is);
        store_some(mixed, here, light + i);
    }
    integrate_tile(blend.grid, blend.tiles, blend.light, blend.pass.view_depth, tile,
                   blend.sums.values.data() + 4 * tile * blend.grid.faces.size());
    forget_unknown(light, count);
}

void blend_block(const Blend& blend, ivec2 corner) {
    static thread_local Bounds bounds;
    static thread_local std::array<Joined, block_size.x + 2> joined;
    static thread_local std::vector<Column> rows; // per tile
    const ivec2 size = blend.grid.size, from = glm::max(corner - 1, 0), to = glm::min(corner + block_size + 1, size);
    const int width = to.x - from.x;
    const size_t tiles = static_cast<size_t>(width) * static_cast<size_t>(to.y - from.y);
    bounds.resize(tiles, 4 * static_cast<size_t>(blend.grid.slices()));
    rows.assign(tiles, {});
    const auto place = [&](int x, int y) { return static_cast<size_t>((y - from.y) * width + x - from.x); };
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
            const size_t tile = blend.grid.tile_index({x, y}), at = place(x, y) * bounds.stride;
            if (blend.stands(tile)) continue;
            find_bounds(blend, tile, &bounds.low[at], &bounds.high[at]);
            // A tile also bounds the slice behind its last visible one.
            rows[place(x, y)] = {&bounds.low[at], &bounds.high[at], blend.seen(tile) + 4};
        }
    const ivec2 end = glm::min(corner + block_size, size);
    for (int y = corner.y; y < end.y; ++y) {
        std::array<Column, block_size.x + 2> columns;
        for (int x = from.x; x < to.x; ++x) {
            Column some[3];
            size_t count = 0;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size.y - 1); ++j)
                if (const Column& row = rows[place(x, j)]; row.reach > 0) some[count++] = row;
            const size_t at = static_cast<size_t>(x - from.x);
            columns[at] = joined[at].join({some, count}, bounds.stride);
        }
        for (int x = corner.x; x < end.x; ++x) {
            const int first = std::max(x - 1, from.x), last = std::min(x + 1, to.x - 1);
            blend_tile(blend, {&columns[static_cast<size_t>(first - from.x)], static_cast<size_t>(last - first + 1)},
                       blend.grid.tile_index({x, y}));
        }
    }
}

void blend_kernel(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& now, const BlendPass& pass,
                  FroxelLight& light, FroxelSums& sums) {
    Blend blend{grid, tiles, now, pass, light, sums};
    blend.slices.resize(grid.tiles());
    parallel_ranges(static_cast<int64_t>(grid.tiles()), 1024, [&](int64_t begin, int64_t end) {
        for (size_t tile = static_cast<size_t>(begin); tile < static_cast<size_t>(end); ++tile)
            blend.slices[tile] = static_cast<uint32_t>(seen_slices(grid, tiles, tile));
    });
    const ivec2 blocks = (grid.size + block_size - 1) / block_size;
    parallel_for(int64_t{blocks.x} * blocks.y,
                 [&](int64_t b) { blend_block(blend, block_size * ivec2(b % blocks.x, b / blocks.x)); });
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(blend_kernel);
FroxelSums blend_history(const FroxelGrid& grid, const FroxelTiles& tiles, const FroxelLight& now,
                         const BlendPass& pass, FroxelLight& light) {
    FroxelSums sums;
    sums.values.resize(4 * grid.tiles() * grid.faces.size());
    HWY_DYNAMIC_DISPATCH(blend_kernel)(grid, tiles, now, pass, light, sums);
    return sums;
}
}
#endif

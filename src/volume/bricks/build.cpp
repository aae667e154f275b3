// Builds bricks from leaves and tiles: finds each brick's sources, packs the nonuniform bricks and drops the rest.
#include "base/error.h"
#include "base/parallel.h"
#include "base/process.h"
#include "base/text.h"
#include "volume/bricks/brick_sources.h"
#include "volume/bricks/half.h"

#include <sys/mman.h>

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr int64_t largest_index = int64_t{256} << 20; // bytes
constexpr int64_t longest_axis = 1 << 20;             // bricks; floats can still distinguish the voxels
constexpr int64_t farthest_voxel = int64_t{1} << 30;

// The eight cells that contribute voxels to one brick, d = 4·dx + 2·dy + dz.
using Corners = std::array<int32_t, 8>;

// The arrays of a pool during construction.
struct BrickArrays {
    std::vector<int32_t> index;
    std::vector<uint16_t> values;
    std::vector<float> constants, minimum, maximum;
};

// Voxels in leaves and tiles.
double voxels_stored(const SparseVolume& volume) {
    double voxels = 512.0 * static_cast<double>(volume.leaves.size());
    for (const Tile& tile : volume.tiles) voxels += voxels_in(tile);
    return voxels;
}

// Bricks along an axis, with one layer of zeros before the first voxel and one after the last.
int64_t bricks_along(const VoxelBox& box, int axis) {
    return ((int64_t{box.high[axis]} + 1) >> 3) - ((int64_t{box.low[axis]} - 1) >> 3) + 1;
}

// Why the index of a box is too large; empty if it is not. Only a nearly empty box suggests stray voxels.
std::string span_problem(const VoxelBox& box, const SparseVolume& volume) {
    constexpr double nearly_empty = 0.01;
    int64_t cells = 1;
    bool fits = true;
    for (int axis = 0; axis < 3 && fits; ++axis)
        fits = bricks_along(box, axis) <= longest_axis &&
               (cells *= bricks_along(box, axis)) * int64_t{sizeof(int32_t)} <= largest_index;
    if (fits) return {};
    const dvec3 size = dvec3(box.high) - dvec3(box.low) + 1.0;
    const bool is_stray = voxels_stored(volume) < nearly_empty * size.x * size.y * size.z;
    return formatted("spans %.0fx%.0fx%.0f voxels, too many to store: ", size.x, size.y, size.z) +
           (is_stray ? "a few stray voxels far away are enough; remove them, or use larger voxels"
                     : "use larger voxels");
}

void size_pool(const SparseVolume& volume, const VoxelBox& box, BrickPool& pool) {
    for (int axis = 0; axis < 3; ++axis)
        if (int64_t{box.low[axis]} < -farthest_voxel || box.high[axis] > farthest_voxel)
            refuse(volume.name, "voxel coordinates go beyond 2^30; move the grid by its transform instead");
    if (const std::string why = span_problem(box, volume); !why.empty())
        fail(ExitCode::out_of_memory, volume.name, "fog " + why);
    for (int axis = 0; axis < 3; ++axis) {
        pool.low[axis] = static_cast<int>(((int64_t{box.low[axis]} - 1) >> 3) * 8);
        pool.size[axis] = static_cast<int>(bricks_along(box, axis));
    }
    pool.local_bounds = {vec3(box.low - pool.low - 1), vec3(box.high - pool.low + 1)};
}

Corners corners_of(const BrickPool& pool, const Sources& sources, ivec3 cell) {
    Corners corners;
    for (int d = 0; d < 8; ++d) {
        const ivec3 at = cell + ivec3(d >> 2, (d >> 1) & 1, d & 1);
        const bool inside = at.x < pool.size.x && at.y < pool.size.y && at.z < pool.size.z;
        corners[d] = inside ? sources.cells[cell_at(pool, at)] : 0;
    }
    return corners;
}

// 0 = empty, 1 = must be packed, -h = constant with half value h.
int32_t kind_of(const Corners& corners, const Sources& sources) {
    const uint16_t tile = corners[0] < 0 ? sources.tiles[-corners[0] - 1] : 0;
    bool empty = true, constant = tile != 0;
    for (int d = 0; d < 8; ++d) {
        const int32_t source = corners[d];
        empty &= source == 0 || (source > 0 && !((sources.summaries[source - 1].parts >> d) & 1));
        constant &= source < 0 && sources.tiles[-source - 1] == tile;
    }
    return empty ? 0 : constant ? -int32_t{tile} : 1;
}

// Marks every index cell with its kind and lists the bricks to pack, in order.
std::vector<ivec3> listed_bricks(const BrickPool& pool, const Sources& sources, BrickArrays& arrays) {
    arrays.index.assign(static_cast<size_t>(cell_count(pool)), 0);
    std::vector<std::vector<ivec3>> slabs(pool.size.x);
    parallel_for(pool.size.x, [&](int64_t x) {
        for (int y = 0; y < pool.size.y; ++y)
            for (int z = 0; z < pool.size.z; ++z) {
                const ivec3 cell(static_cast<int>(x), y, z);
                const int32_t kind = kind_of(corners_of(pool, sources, cell), sources);
                arrays.index[static_cast<size_t>(cell_at(pool, cell))] = kind;
                if (kind == 1) slabs[x].push_back(cell);
            }
    });
    std::vector<ivec3> list;
    for (const std::vector<ivec3>& slab : slabs) list.insert(list.end(), slab.begin(), slab.end());
    return list;
}

// Writes the 9³ values of a brick and returns their range.
HalfRange pack(const Corners& corners, const Sources& sources, uint16_t* values) {
    static constexpr std::array<float, 8> nothing{};
    float buffer[729];
    for (int x = 0; x < 9; ++x)
        for (int y = 0; y < 9; ++y) {
            float* to = buffer + (x * 9 + y) * 9;
            for (const int z : {0, 8}) {
                const int32_t source = corners[4 * (x >> 3) + 2 * (y >> 3) + (z >> 3)];
                const Leaf* leaf = source > 0 ? sources.leaves[source - 1] : nullptr;
                const float* from = leaf ? &leaf->values[(x & 7) * 64 + (y & 7) * 8] : nothing.data();
                if (source < 0)
                    std::fill_n(to + z, z ? 1 : 8, float_from_half(sources.tiles[-source - 1]));
                else if (z == 0)
                    std::copy_n(from, 8, to);
                else
                    to[8] = from[0];
            }
        }
    return halves_from_floats(buffer, 729, values);
}

std::vector<HalfRange> packed_bricks(const std::string& name, const std::vector<ivec3>& list, const Sources& sources,
                                     const BrickPool& pool, BrickArrays& arrays) {
    const double bytes = static_cast<double>(list.size()) * brick_stride * sizeof(uint16_t);
    const double memory = static_cast<double>(physical_memory());
    if (bytes > memory)
        fail(ExitCode::out_of_memory, name,
             "its bricks take " + std::to_string(static_cast<int64_t>(bytes / 1e6)) + " MB, this machine has " +
                 std::to_string(static_cast<int64_t>(memory / 1e6)) + " MB. Use larger voxels");
    // Huge pages, if available, take a fraction of the time of small pages on first touch.
    arrays.values.reserve(list.size() * brick_stride);
    constexpr uintptr_t page = uintptr_t{2} << 20;
    const auto room = reinterpret_cast<uintptr_t>(arrays.values.data());
    const uintptr_t low = (room + page - 1) & ~(page - 1), high = (room + list.size() * brick_stride * 2) & ~(page - 1);
    if (low < high) madvise(reinterpret_cast<void*>(low), high - low, MADV_HUGEPAGE);
    arrays.values.resize(list.size() * brick_stride);
    std::vector<HalfRange> packed(list.size());
    parallel_ranges(static_cast<int64_t>(list.size()), 16, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i)
            packed[i] = pack(corners_of(pool, sources, list[i]), sources, &arrays.values[i * brick_stride]);
    });
    return packed;
}

// Turns the marks in the index into brick and constant ids, and compacts the values to remove uniform bricks.
void finish_index(const std::vector<HalfRange>& packed, BrickArrays arrays, BrickPool& pool) {
    arrays.minimum.assign(arrays.index.size(), 0);
    arrays.maximum = arrays.minimum;
    std::vector<int32_t> constant_of(half_from_float(largest_half) + 1, 0);
    size_t next = 0, bricks = 0, filled = 0;
    for (size_t cell = 0; cell < arrays.index.size(); ++cell) {
        int32_t& id = arrays.index[cell];
        if (id == 0) continue;
        ++filled;
        const auto tile = static_cast<uint16_t>(-id);
        const HalfRange brick = id > 0 ? packed[next] : HalfRange{tile, tile};
        arrays.minimum[cell] = float_from_half(brick.low), arrays.maximum[cell] = float_from_half(brick.high);
        if (brick.low == brick.high) {
            int32_t& constant = constant_of[brick.high];
            if (constant == 0) {
                arrays.constants.push_back(arrays.maximum[cell]);
                constant = -static_cast<int32_t>(arrays.constants.size());
            }
            next += id > 0, id = constant;
        } else {
            const uint16_t* from = &arrays.values[next * brick_stride];
            if (bricks != next) std::copy_n(from, brick_stride, &arrays.values[bricks * brick_stride]);
            ++next, id = static_cast<int32_t>(++bricks);
        }
        pool.highest = std::max(pool.highest, arrays.maximum[cell]);
    }
    arrays.values.resize(bricks * brick_stride);
    if (arrays.values.size() < arrays.values.capacity() / 4 * 3) arrays.values.shrink_to_fit();
    const ivec3 reach = (ivec3(pool.local_bounds.high) - 1) / 8; // the last bricks that can hold fog
    const size_t bricks_within = static_cast<size_t>(reach.x + 1) * (reach.y + 1) * (reach.z + 1);
    pool.crowded = bricks_within - filled <= bricks_within / 16;
    pool.mean_in_bricks = static_cast<float>(pool.mass / (512.0 * static_cast<double>(filled)));
    pool.index = std::move(arrays.index), pool.values = std::move(arrays.values);
    pool.constants = std::move(arrays.constants);
    pool.minimum = std::move(arrays.minimum), pool.maximum = std::move(arrays.maximum);
}
}

void check_bricks(const SparseVolume& volume) {
    BrickPool pool;
    const Sources sources = make_sources(volume);
    if (!sources.box.empty()) size_pool(volume, sources.box, pool);
}

std::string bricks_problem(const SparseVolume& volume) {
    const Sources sources = make_sources(volume);
    return sources.box.empty() ? std::string() : span_problem(sources.box, volume);
}

std::shared_ptr<const BrickPool> make_bricks(const SparseVolume& volume) {
    auto pool = std::make_shared<BrickPool>();
    Sources sources = make_sources(volume);
    if (!sources.box.empty()) {
        size_pool(volume, sources.box, *pool);
        pool->mass = sources.mass;
        fill_cells(*pool, volume, sources);
        BrickArrays arrays;
        const std::vector<ivec3> list = listed_bricks(*pool, sources, arrays);
        const std::vector<HalfRange> packed = packed_bricks(volume.name, list, sources, *pool, arrays);
        finish_index(packed, std::move(arrays), *pool);
    }
    place(*pool, volume.index_to_world);
    return pool;
}
}

#include "volume/bricks/brick_sources.h"

#include "base/parallel.h"
#include "volume/bricks/half.h"
#include "volume/bricks/voxel_mask.h"

#include <algorithm>

namespace tyndall {
namespace {
LeafSummary summary_of(const Leaf& leaf) {
    LeafSummary summary;
    const VoxelMask filled = voxels_above(leaf.values, smallest_half / 2);
    uint64_t rows = 0; // bit y·8 + z
    for (const uint64_t word : filled) rows |= word;
    if (rows == 0) return summary;

    // Part d holds the voxels shared with the lower neighbor brick -d: only layer 0 in x, y, z for bits 4, 2, 1.
    constexpr uint64_t first_y = 0xff, first_z = 0x0101010101010101u;
    for (int d = 0; d < 8; ++d) {
        const uint64_t shared = (d & 2 ? first_y : ~uint64_t{0}) & (d & 1 ? first_z : ~uint64_t{0});
        const bool used = ((d & 4 ? filled[0] : rows) & shared) != 0;
        summary.parts |= static_cast<uint8_t>(used << d);
    }
    ivec3 low, high;
    bounds_of(filled, low, high);
    summary.box = {leaf.origin + low, leaf.origin + high};
    std::array<float, 8> sums{}; // per z
    for (int row = 0; row < 64; ++row)
        for (int z = 0; z < 8; ++z) {
            const float value = leaf.values[row * 8 + z];
            sums[z] += value > 0 ? std::min(value, largest_half) : 0;
        }
    for (const float sum : sums) summary.mass += sum;
    return summary;
}

// Accumulates the box and the mass of all leaves and tiles.
void sum_up(const SparseVolume& volume, Sources& sources) {
    for (const LeafSummary& summary : sources.summaries)
        if (summary.parts) sources.box.grow(summary.box), sources.mass += summary.mass;
    for (size_t i = 0; i < volume.tiles.size(); ++i) {
        if (sources.tiles[i] == 0) continue;
        const Tile& tile = volume.tiles[i];
        sources.box.grow({tile.low, tile.high});
        sources.mass += voxels_in(tile) * std::min(tile.value, largest_half);
    }
}

// Marks the cells that a tile covers completely, and fills a partial leaf in every cell it covers only in part.
void add_tile(const BrickPool& pool, const Tile& tile, int32_t tile_index, Sources& sources) {
    const ivec3 low = tile.low - pool.low, high = tile.high - pool.low;
    const ivec3 first = low / 8, last = high / 8;
    for (int x = first.x; x <= last.x; ++x)
        for (int y = first.y; y <= last.y; ++y)
            for (int z = first.z; z <= last.z; ++z) {
                const ivec3 corner = ivec3(x, y, z) * 8;
                int32_t& cell = sources.cells[cell_at(pool, ivec3(x, y, z))];
                if (cell > 0 && cell <= static_cast<int32_t>(sources.leaves.size())) continue;
                const ivec3 from = glm::max(low - corner, ivec3(0)), to = glm::min(high - corner, ivec3(7));
                if (from == ivec3(0) && to == ivec3(7)) {
                    cell = -tile_index - 1;
                    continue;
                }
                if (cell == 0) {
                    sources.partial.push_back(Leaf{corner + pool.low});
                    cell = static_cast<int32_t>(sources.leaves.size() + sources.partial.size());
                }
                Leaf& leaf = sources.partial[cell - 1 - sources.leaves.size()];
                for (int i = from.x; i <= to.x; ++i)
                    for (int j = from.y; j <= to.y; ++j)
                        std::fill_n(&leaf.values[i * 64 + j * 8 + from.z], to.z - from.z + 1, tile.value);
            }
}
}

Sources make_sources(const SparseVolume& volume) {
    Sources sources;
    for (const Leaf& leaf : volume.leaves) sources.leaves.push_back(&leaf);
    sources.summaries.resize(volume.leaves.size());
    parallel_ranges(static_cast<int64_t>(volume.leaves.size()), 16, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) sources.summaries[i] = summary_of(volume.leaves[i]);
    });
    for (const Tile& tile : volume.tiles) sources.tiles.push_back(half_from_float(tile.value));
    sum_up(volume, sources);
    return sources;
}

void fill_cells(const BrickPool& pool, const SparseVolume& volume, Sources& sources) {
    sources.cells.assign(static_cast<size_t>(cell_count(pool)), 0);
    for (size_t i = 0; i < volume.leaves.size(); ++i)
        if (sources.summaries[i].parts)
            sources.cells[cell_at(pool, (volume.leaves[i].origin - pool.low) / 8)] = static_cast<int32_t>(i + 1);
    for (size_t i = 0; i < volume.tiles.size(); ++i)
        if (sources.tiles[i]) add_tile(pool, volume.tiles[i], static_cast<int32_t>(i), sources);
    for (const Leaf& leaf : sources.partial) {
        sources.leaves.push_back(&leaf);
        sources.summaries.push_back(summary_of(leaf));
    }
}
}

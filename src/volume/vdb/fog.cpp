#include "volume/vdb/fog.h"

#include "base/error.h"
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <tuple>

namespace tyndall {
namespace {
ivec3 voxel(uint32_t offset) { return {offset >> 6, offset >> 3 & 7, offset & 7}; }

void grow(ActiveBox& box, ivec3 low, ivec3 high) {
    if (box.empty()) box = {low, high};
    box.low = glm::min(box.low, low), box.high = glm::max(box.high, high);
}

bool contains(const ActiveBox& box, ivec3 low, ivec3 high) {
    return glm::all(glm::lessThanEqual(box.low, low)) && glm::all(glm::lessThanEqual(high, box.high));
}

uint64_t voxel_count(const Tile& tile) { return static_cast<uint64_t>(voxels_in(tile)); }

struct Corrections {
    uint64_t non_finite = 0, negative = 0;
};

// Clamps nonfinite and negative values to 0 and counts them.
float cleaned(float value, uint64_t voxels, Corrections& corrections) {
    if (!std::isfinite(value)) return corrections.non_finite += voxels, 0.0f;
    if (value < 0) return corrections.negative += voxels, 0.0f;
    return value;
}

// True if all values are finite and nonnegative: as integers, such floats are below infinity. `any`: not all are 0.
bool is_clean(const Leaf& leaf, bool& any) {
    constexpr int32_t bits_of_infinity = 0x7f800000;
    int32_t all = 0, wrong = 0;
    for (const float value : leaf.values) {
        const auto bits = std::bit_cast<int32_t>(value);
        all |= bits, wrong |= bits >= bits_of_infinity;
    }
    any = all != 0;
    return all >= 0 && !wrong;
}

// Returns true if the leaf still has nonzero values.
bool clean_leaf(Leaf& leaf, const ActiveBox& box, Corrections& corrections) {
    const bool inside = contains(box, leaf.origin, leaf.origin + 7);
    bool any = false;
    if (inside && is_clean(leaf, any)) return any;
    any = false;
    for (uint32_t v = 0; v < 512; ++v) {
        const ivec3 at = leaf.origin + voxel(v);
        float& value = leaf.values[v];
        value = inside || contains(box, at, at) ? cleaned(value, 1, corrections) : 0.0f;
        any = any || value != 0;
    }
    return any;
}

void clean_leaves(Leaves& leaves, const ActiveBox& box, Corrections& corrections) {
    std::vector<uint8_t> keep(leaves.size());
    std::atomic<uint64_t> non_finite = 0, negative = 0;
    parallel_ranges(static_cast<int64_t>(leaves.size()), 256, [&](int64_t begin, int64_t end) {
        Corrections local;
        for (int64_t i = begin; i < end; ++i) {
            const auto n = static_cast<size_t>(i);
            keep[n] = clean_leaf(leaves[n], box, local);
        }
        non_finite += local.non_finite, negative += local.negative;
    });
    corrections.non_finite += non_finite, corrections.negative += negative;

    size_t kept = 0;
    for (size_t n = 0; n < leaves.size(); ++n) {
        if (!keep[n]) continue;
        if (kept != n) leaves[kept] = leaves[n];
        ++kept;
    }
    leaves.resize(kept);
    leaves.shrink_to_fit();
}

// Appends the parts of tiles inside the active box that contain fog.
void append_tiles(const std::vector<Tile>& from, const ActiveBox& box, std::vector<Tile>& to,
                  Corrections& corrections) {
    for (Tile tile : from) {
        tile.low = glm::max(tile.low, box.low), tile.high = glm::min(tile.high, box.high);
        if (glm::any(glm::lessThan(tile.high, tile.low))) continue;
        tile.value = cleaned(tile.value, voxel_count(tile), corrections);
        if (tile.value != 0) to.push_back(tile);
    }
}

// A nonzero background also fills the root cells inside the active box that the file does not mention.
std::vector<Tile> background_tiles(DecodedTree& tree, const ActiveBox& box, const std::string& where) {
    constexpr int cell = 4096;
    constexpr int64_t max_cells = 1 << 15;
    const ivec3 first = box.low >> 12, last = box.high >> 12, size = last - first + 1;
    if (int64_t{size.x} * size.y * size.z > max_cells)
        refuse(where, "has a nonzero background and voxels too far apart to fill the space between them");
    const auto before = [](ivec3 a, ivec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    std::ranges::sort(tree.root_nodes, before);

    std::vector<Tile> tiles;
    for (int x = first.x; x <= last.x; ++x)
        for (int y = first.y; y <= last.y; ++y)
            for (int z = first.z; z <= last.z; ++z) {
                const ivec3 low = ivec3(x, y, z) * cell;
                if (std::ranges::binary_search(tree.root_nodes, low, before)) continue;
                tiles.push_back({low, low + cell - 1, tree.background});
            }
    return tiles;
}
}

ActiveBox active_box(const DecodedTree& tree) {
    ActiveBox box;
    for (size_t n = 0; n < tree.leaves.size(); ++n) {
        const ivec3 origin = tree.leaves[n].origin;
        if (!box.empty() && contains(box, origin, origin + 7)) continue;
        for (uint32_t word = 0; word < 8; ++word)
            for (uint64_t bits = tree.active[n][word]; bits != 0; bits &= bits - 1) {
                const ivec3 at = origin + voxel(64 * word + static_cast<uint32_t>(std::countr_zero(bits)));
                grow(box, at, at);
            }
    }
    for (const Tile& tile : tree.active_tiles) grow(box, tile.low, tile.high);
    return box;
}

void make_fog(DecodedTree tree, SparseVolume& volume, VdbReadReport& report, const std::string& where) {
    const ActiveBox box = active_box(tree);
    volume.active_low = box.low, volume.active_high = box.high;
    report.empty = box.empty();
    report.background = std::isfinite(tree.background) ? tree.background : 0.0f;
    if (box.empty()) return;

    Corrections corrections;
    std::vector<VoxelMask>().swap(tree.active);
    volume.leaves = std::move(tree.leaves);
    clean_leaves(volume.leaves, box, corrections);
    append_tiles(tree.active_tiles, box, volume.tiles, corrections);
    append_tiles(tree.inactive_tiles, box, volume.tiles, corrections);
    if (report.background != 0) append_tiles(background_tiles(tree, box, where), box, volume.tiles, corrections);
    report.non_finite = corrections.non_finite, report.negative = corrections.negative;
}

void apply(const ValueMap& map, DecodedTree& tree) {
    if (map.changes_nothing()) return;
    const bool everywhere = map.width > 0;
    parallel_ranges(static_cast<int64_t>(tree.leaves.size()), 64, [&](int64_t begin, int64_t end) {
        for (auto n = static_cast<size_t>(begin); n < static_cast<size_t>(end); ++n)
            for (uint32_t v = 0; v < 512; ++v) {
                float& value = tree.leaves[n].values[v];
                if (everywhere || value != 0 || contains(tree.active[n], v)) value = map(value);
            }
    });
    for (Tile& tile : tree.active_tiles) tile.value = map(tile.value);
    for (Tile& tile : tree.inactive_tiles) tile.value = map(tile.value);
    if (everywhere || tree.background != 0) tree.background = map(tree.background);
}

void limit(DecodedTree& tree, float most, VdbReadReport& report) {
    report.most = most;
    for (size_t n = 0; n < tree.leaves.size(); ++n)
        for (uint32_t v = 0; v < 512; ++v) {
            float& value = tree.leaves[n].values[v];
            if (!(value > most) || std::isinf(value)) continue;
            report.above += contains(tree.active[n], v), value = most;
        }
    for (Tile& tile : tree.active_tiles)
        if (tile.value > most && !std::isinf(tile.value)) report.above += voxel_count(tile), tile.value = most;
    for (Tile& tile : tree.inactive_tiles)
        if (!std::isinf(tile.value)) tile.value = std::min(tile.value, most);
}

void keep_active(DecodedTree& tree) {
    for (size_t n = 0; n < tree.leaves.size(); ++n)
        for (uint32_t v = 0; v < 512; ++v)
            if (!contains(tree.active[n], v)) tree.leaves[n].values[v] = 0;
    tree.inactive_tiles.clear(), tree.background = 0;
}

void keep_finite(DecodedTree& tree, VdbReadReport& report) {
    for (size_t n = 0; n < tree.leaves.size(); ++n)
        for (uint32_t v = 0; v < 512; ++v) {
            float& value = tree.leaves[n].values[v];
            if (std::isfinite(value)) continue;
            report.non_finite += contains(tree.active[n], v), value = 0;
        }
    for (Tile& tile : tree.active_tiles)
        if (!std::isfinite(tile.value)) report.non_finite += voxel_count(tile), tile.value = 0;
}

void make_plain(DecodedTree tree, SparseVolume& volume) {
    keep_active(tree);
    const ActiveBox box = active_box(tree);
    volume.active_low = box.low, volume.active_high = box.high;
    volume.leaves = std::move(tree.leaves), volume.tiles = std::move(tree.active_tiles);
}

DecodedTree active_mask(DecodedTree tree) {
    for (size_t n = 0; n < tree.leaves.size(); ++n)
        for (uint32_t v = 0; v < 512; ++v) tree.leaves[n].values[v] = static_cast<float>(contains(tree.active[n], v));
    for (Tile& tile : tree.active_tiles) tile.value = 1;
    tree.inactive_tiles.clear(), tree.background = 0;
    return tree;
}

void add_statistics(const DecodedTree& tree, VdbGridInfo& info) {
    double sum = 0;
    uint64_t finite = 0;
    float low = infinity, high = -infinity;
    const auto add = [&](float value, uint64_t voxels) {
        if (!std::isfinite(value)) {
            info.non_finite += voxels;
            return;
        }
        if (value < 0) info.negative += voxels;
        low = std::min(low, value), high = std::max(high, value);
        sum += static_cast<double>(value) * static_cast<double>(voxels), finite += voxels;
    };
    for (size_t n = 0; n < tree.leaves.size(); ++n)
        for (uint32_t v = 0; v < 512; ++v)
            if (contains(tree.active[n], v)) add(tree.leaves[n].values[v], 1);
    for (const Tile& tile : tree.active_tiles) add(tile.value, voxel_count(tile));
    if (finite > 0) info.minimum = low, info.maximum = high, info.mean = static_cast<float>(sum / finite);
    info.background = tree.background;
}
}

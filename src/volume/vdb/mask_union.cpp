#include "volume/vdb/mask_union.h"

#include "volume/vdb/fog.h"
#include "volume/vdb/tree_order.h"

#include <algorithm>
#include <tuple>

namespace tyndall {
namespace {
bool before(ivec3 a, ivec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// The tiles of trees, which are cells of one hierarchy: any two of them are disjoint or nested.
class TileCells {
public:
    explicit TileCells(std::span<const Tile> tiles) {
        for (const Tile& tile : tiles)
            for (size_t level = 0; level < 3; ++level)
                if (tile.high.x - tile.low.x + 1 == sizes[level]) lows_[level].push_back(tile.low);
        for (std::vector<ivec3>& lows : lows_) {
            std::ranges::sort(lows, before);
            lows.erase(std::unique(lows.begin(), lows.end()), lows.end());
        }
    }

    // Whether a tile of this level or a higher one covers the voxel.
    bool cover(ivec3 voxel, size_t level = 0) const {
        for (; level < 3; ++level)
            if (std::ranges::binary_search(lows_[level], voxel & ivec3(-sizes[level]), before)) return true;
        return false;
    }

    // Masks of the tiles that no larger one covers.
    std::vector<Tile> outermost() const {
        std::vector<Tile> tiles;
        for (size_t level = 0; level < 3; ++level)
            for (const ivec3 low : lows_[level])
                if (!cover(low, level + 1)) tiles.push_back({low, low + sizes[level] - 1, 1});
        return tiles;
    }

private:
    static constexpr int sizes[] = {8, 128, 4096};
    std::array<std::vector<ivec3>, 3> lows_; // lower corners by level, sorted
};
}

bool same_voxels(const DecodedTree& a, const DecodedTree& b) {
    const auto same_box = [](const Tile& s, const Tile& t) { return s.low == t.low && s.high == t.high; };
    return a.active == b.active && std::ranges::equal(a.leaves, b.leaves, {}, &Leaf::origin, &Leaf::origin) &&
           std::ranges::equal(a.active_tiles, b.active_tiles, same_box);
}

void unite(DecodedTree& mask, const DecodedTree& other) {
    if (same_voxels(mask, other)) return;
    std::vector<Tile> tiles = mask.active_tiles;
    tiles.insert(tiles.end(), other.active_tiles.begin(), other.active_tiles.end());
    const TileCells cells(tiles);
    std::vector<ivec3> origins;
    std::vector<VoxelMask> active = mask.active;
    active.insert(active.end(), other.active.begin(), other.active.end());
    for (const DecodedTree* tree : std::array<const DecodedTree*, 2>{&mask, &other})
        for (const Leaf& leaf : tree->leaves) origins.push_back(leaf.origin);

    DecodedTree both;
    both.root_nodes = std::move(mask.root_nodes), both.active_tiles = cells.outermost();
    for (const uint32_t n : in_tree_order(origins)) {
        if (cells.cover(origins[n])) continue;
        if (both.leaves.empty() || both.leaves.back().origin != origins[n])
            both.leaves.push_back({origins[n]}), both.active.emplace_back();
        for (size_t word = 0; word < 8; ++word) both.active.back()[word] |= active[n][word];
    }
    mask = active_mask(std::move(both));
}
}

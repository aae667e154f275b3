#include "trace/shadows/maps/shadow_blocks.h"

#include "base/parallel.h"

#include <bit>

namespace tyndall {
namespace {
constexpr float rounding = 2e-6f; // exceeds the rounding of lookups, and their offset of surfaces
constexpr float max_across = 2;   // a box is at most this many blocks of its level wide

ivec2 blocks_of(ivec2 texels) { return (texels + block_side - 1) / block_side; }
size_t area(ivec2 size) { return static_cast<size_t>(size.x) * static_cast<size_t>(size.y); }

void grow(DepthRange& range, float nearest, float farthest) {
    range.nearest = std::min(range.nearest, nearest), range.farthest = std::max(range.farthest, farthest);
}

void fill_smallest(const ShadowImage& image, const float* depth, DepthRange* blocks) {
    const ivec2 count = blocks_of(image.size);
    parallel_for(count.y, [&](int64_t row) {
        DepthRange* of_row = blocks + row * count.x;
        std::fill_n(of_row, count.x, DepthRange{});
        const int first = static_cast<int>(row) * block_side, last = std::min(first + block_side, image.size.y);
        for (int y = first; y < last; ++y)
            for (int x = 0; x < image.size.x; ++x) {
                const float at = depth[static_cast<size_t>(y) * static_cast<size_t>(image.size.x) + x];
                grow(of_row[x / block_side], at == unseen_depth ? infinity : at, at);
            }
    });
}

// The next level: each block covers 2×2 finer ones.
void fill_larger(const DepthRange* fine, ivec2 fine_count, DepthRange* coarse) {
    const ivec2 count = (fine_count + 1) / 2;
    std::fill_n(coarse, area(count), DepthRange{});
    for (int y = 0; y < fine_count.y; ++y)
        for (int x = 0; x < fine_count.x; ++x, ++fine)
            grow(coarse[y / 2 * count.x + x / 2], fine->nearest, fine->farthest);
}

// Depth range of all texels that overlap a rectangle of texel coordinates, which lies inside the picture.
DepthRange range_in(const ShadowMap& map, const ShadowImage& image, vec2 low, vec2 high) {
    // On the level whose blocks are at least half as wide as the rectangle, 3×3 blocks cover it.
    const float share = std::max(high.x - low.x, high.y - low.y) / (max_across * block_side);
    const int exponent = static_cast<int>(std::bit_cast<uint32_t>(share) >> 23) - 126; // share <= 2^exponent
    const int level = std::clamp(exponent, 0, image.levels - 1);
    const DepthRange* blocks = map.blocks.data() + image.first_block[static_cast<size_t>(level)];
    const int side = block_side << level;
    const ivec2 count = (image.size + side - 1) / side, first = ivec2(low) / side;
    const ivec2 last = glm::min(ivec2(high) / side, count - 1);
    DepthRange range;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) {
            const ivec2 at = glm::min(first + ivec2(x, y), last);
            const DepthRange& block = blocks[at.y * count.x + at.x];
            grow(range, block.nearest, block.farthest);
        }
    return range;
}
}

void make_blocks(ShadowMap& map) {
    size_t total = 0;
    for (ShadowImage& image : map.images) {
        ivec2 count = blocks_of(image.size);
        for (image.levels = 0;; count = (count + 1) / 2) {
            image.first_block[static_cast<size_t>(image.levels++)] = total;
            total += area(count);
            if (area(count) <= 1 || image.levels == max_levels) break;
        }
    }
    map.blocks.resize(total);
    for (const ShadowImage& image : map.images) {
        DepthRange* blocks = map.blocks.data() + image.first_block[0];
        fill_smallest(image, map.depth.data() + image.first, blocks);
        ivec2 count = blocks_of(image.size);
        for (int level = 1; level < image.levels; ++level, count = (count + 1) / 2) {
            fill_larger(blocks, count, blocks + area(count));
            blocks += area(count);
        }
    }
}

Lit lit_in_box(const ShadowMap& map, vec3 low, vec3 high) {
    if (map.empty()) return Lit::all;
    if (map.projection != LightProjection::parallel || map.blocks.empty()) return Lit::some;
    const float depth = low.z - std::abs(low.z) * rounding;
    const float filter = map.pcf == 0 ? 0.0f : map.pcf == 1 ? 0.5f : 1.5f;
    for (const ShadowImage& image : map.images) {
        // The box in texels, and whether lookups treat it as inside, outside, or both.
        const vec2 slack_texels = (glm::abs(image.offset) + vec2(image.size)) * rounding;
        const vec2 from = vec2(low) * image.scale + image.offset - slack_texels;
        const vec2 to = vec2(high) * image.scale + image.offset + slack_texels;
        const vec2 begin(shadow_guard), end = vec2(image.size) - shadow_guard;
        if (to.x < begin.x || to.y < begin.y || from.x > end.x || from.y > end.y) continue;
        const bool inside = from.x >= begin.x && from.y >= begin.y && to.x <= end.x && to.y <= end.y;
        if (!inside) return Lit::some;
        const DepthRange range = range_in(map, image, from - filter, to + filter);
        const float texel = 1 / std::min(image.scale.x, image.scale.y);
        if (depth - map.bias * texel > range.farthest) return Lit::none;
        return high.z <= range.nearest ? Lit::all : Lit::some;
    }
    return Lit::all;
}
}

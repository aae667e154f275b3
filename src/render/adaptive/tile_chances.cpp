#include "render/adaptive/tile_chances.h"

#include "base/random.h"
#include "trace/sampling/lamp_samples.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr uint32_t use_tiles = 0x9170u;

TileChances tiles_between(ivec2 low, ivec2 high) {
    TileChances tiles{low / tile_side, (high - 1) / tile_side + 1 - low / tile_side, {}};
    tiles.chances.assign(static_cast<size_t>(tiles.size.x) * tiles.size.y, 0.0);
    return tiles;
}

ivec2 corner_of(const TileChances& tiles, int tile) {
    return (tiles.low + ivec2(tile % tiles.size.x, tile / tiles.size.x)) * tile_side;
}

// Distributes `share` over tiles in proportion to a function of pixels; evenly if that is 0 everywhere.
template<class Function> void add_share(const Layers& picture, double share, const Function& at, TileChances& tiles) {
    std::vector<double> sums(tiles.chances.size(), 0.0);
    double all = 0;
    for (int y = 0; y < picture.size.y; ++y)
        for (int x = 0; x < picture.size.x; ++x) {
            const ivec2 tile = (picture.low + ivec2(x, y)) / tile_side - tiles.low;
            const double value = at(x, y);
            sums[static_cast<size_t>(tile.y) * tiles.size.x + tile.x] += value, all += value;
        }
    const double even = share / static_cast<double>(sums.size());
    const bool spread = all > 0 && std::isfinite(all);
    for (size_t i = 0; i < sums.size(); ++i) tiles.chances[i] += spread ? share * sums[i] / all : even;
}

// Tiles within two pixels of a visible lamp.
std::vector<size_t> tiles_with_lamps(const TileChances& tiles, const View& view, const Snapshot& snapshot) {
    constexpr float reach = 2; // pixels
    std::vector<size_t> result;
    const std::vector<View::Lamp> lamps = lamps_in(view, snapshot);
    for (size_t i = 0; !lamps.empty() && i < tiles.chances.size(); ++i) {
        const int tile = static_cast<int>(i);
        const vec2 low(corner_of(tiles, tile)), high = low + float{tile_side};
        if (std::ranges::any_of(lamps, [&](const View::Lamp& lamp) {
                return glm::distance(lamp.at, glm::clamp(lamp.at, low, high)) < lamp.radius + reach;
            }))
            result.push_back(i);
    }
    return result;
}
}

TileChances uniform_chances(const View& view, const Snapshot& snapshot) {
    const bool cropped = view.crop_low != view.crop_high;
    TileChances tiles = cropped ? tiles_between(view.crop_low, view.crop_high) : tiles_between(ivec2(0), view.size);
    const std::vector<size_t> lit = tiles_with_lamps(tiles, view, snapshot);
    const double of_lamps = std::min(static_cast<double>(lit.size()) / drawing_tiles, 0.5);
    std::ranges::fill(tiles.chances, (1 - of_lamps) / static_cast<double>(tiles.chances.size()));
    for (size_t tile : lit) tiles.chances[tile] += of_lamps / static_cast<double>(lit.size());
    return tiles;
}

TileChances chances_in(const Layers& picture) {
    TileChances tiles = tiles_between(picture.low, picture.low + picture.size);
    const auto square = [](vec3 value) { return channel_mean(value * value); };
    add_share(
        picture, 0.25, [](int, int) { return 0.0; }, tiles);
    add_share(
        picture, 0.25, [&](int x, int y) { return square(picture.color.at(x, y)); }, tiles);
    add_share(
        picture, 0.25, [&](int x, int y) { return square(picture.inscatter.at(x, y)); }, tiles);
    add_share(
        picture, 0.125, [&](int x, int y) { return channel_mean(picture.variance.at(x, y)); }, tiles);
    add_share(
        picture, 0.125, [&](int x, int y) { return channel_mean(picture.inscatter_variance.at(x, y)); }, tiles);
    return tiles;
}

TileChances chances_between(const Layers& picture, const Layers& other) {
    constexpr double share = 0.25;
    TileChances tiles = chances_in(picture);
    std::vector<dvec3> sums(tiles.chances.size(), dvec3(0));
    for (int y = 0; y < picture.size.y; ++y)
        for (int x = 0; x < picture.size.x; ++x) {
            const ivec2 tile = (picture.low + ivec2(x, y)) / tile_side - tiles.low;
            sums[static_cast<size_t>(tile.y) * tiles.size.x + tile.x] +=
                dvec3(picture.inscatter.at(x, y)) - dvec3(other.inscatter.at(x, y));
        }
    double all = 0;
    for (const dvec3& sum : sums) all += glm::dot(sum, sum);
    for (size_t i = 0; all > 0 && std::isfinite(all) && i < sums.size(); ++i)
        tiles.chances[i] = (1 - share) * tiles.chances[i] + share * glm::dot(sums[i], sums[i]) / all;
    return tiles;
}

std::vector<DrawnTile> draw_tiles(const TileChances& tiles, size_t count, uint32_t seed) {
    std::vector<DrawnTile> drawn;
    const size_t all = tiles.chances.size();
    const auto corner = [&](size_t i) { return corner_of(tiles, static_cast<int>(i)); };
    if (count >= all) {
        for (size_t i = 0; i < all; ++i) drawn.push_back({corner(i)});
        return drawn;
    }
    // Evenly spaced marks, randomly shifted, on the cumulative chances; a tile is drawn if a mark falls into its
    // interval.
    const double shift = to_unit(hash(seed, use_tiles));
    double sum = 0;
    for (size_t i = 0; i < all; ++i) {
        const double before = sum * static_cast<double>(count) - shift;
        sum += tiles.chances[i];
        const double expected = tiles.chances[i] * static_cast<double>(count);
        const double after =
            i + 1 == all ? static_cast<double>(count) - shift : sum * static_cast<double>(count) - shift;
        const double chance = std::min(expected, 1.0);
        if (std::ceil(after) > std::ceil(before)) drawn.push_back({corner(i), chance, 1 / chance});
    }
    return drawn;
}
}

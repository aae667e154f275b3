#include "render/adaptive/pilot_sums.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr double confidence = 1.96; // standard deviations below which 97.5 % of a normal lie

double channel_mean(dvec3 value) { return (value.x + value.y + value.z) / 3; }
}

Sums sums_of(std::span<const vec3> truth, std::span<const vec3> own, std::span<const vec3> center, size_t layer) {
    Sums sums;
    for (size_t i = 0; i < 16; ++i) {
        const size_t a = 2 * i + layer, b = a + pilot_values / 2;
        if (!is_finite(truth[a] + truth[b] + own[a] + own[b] + center[a])) continue;
        const dvec3 ta(truth[a]), tb(truth[b]), oa(own[a]), ob(own[b]), c(center[a]);
        const double products[] = {channel_mean((oa - ta) * (ob - tb)), 0.5 * channel_mean((oa - ob) * (oa - ob)),
                                   channel_mean((c - ta) * (c - tb))};
        for (int k = 0; k < product_count; ++k)
            sums.products[k] += products[k], sums.squares[k] += products[k] * products[k];
        sums.mean += 0.5 * channel_mean(ta + tb), sums.count += 1;
    }
    return sums;
}

SquaredError squared_error(const TileSums& sums_of_tiles, Product product) {
    const auto& [tiles, lamp_tiles, all] = sums_of_tiles;
    Sums lamps, others;
    for (size_t i = 0; i < tiles.size(); ++i) (i < lamp_tiles ? lamps : others).add(tiles[i], 1);
    if (product == of_sample) lamps.products[product] = lamps.squares[product] = 0;
    const double count = static_cast<double>(tiles.size() - lamp_tiles);
    const double stands_for = count > 0 ? (all - static_cast<double>(lamp_tiles)) / count : 0;
    const auto together = [&](const Sums& some, double share) {
        Sums sums = lamps;
        sums.add(some, share);
        return sums;
    };
    const Sums sums = together(others, stands_for);
    SquaredError result{std::max(sums.square(product), 0.0), 0};
    double mean = 0, squares = 0, seen = 0;
    for (size_t i = lamp_tiles; i < tiles.size() && count > 1; ++i) {
        Sums rest = others;
        rest.add(tiles[i], -1);
        const double value = together(rest, stands_for * count / (count - 1)).square(product), off = value - mean;
        mean += off / ++seen, squares += off * (value - mean);
    }
    double variance = std::max(squares * (count - 1) / std::max(count, 1.0), 0.0);
    if (lamps.squares[product] > 0)
        variance += lamps.squares[product] * std::pow(sums.count / (sums.mean * sums.mean), 2);
    result.bound = result.value + confidence * std::sqrt(variance);
    if (!(result.bound >= 0)) result.bound = infinity;
    return result;
}
}

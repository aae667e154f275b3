// Sums over tiles, then over their scores.
#include "measure/tile_scores.h"

#include <cassert>

namespace tyndall {
namespace {
constexpr int side = 8;
constexpr double dark = 0.01, wanted = 0.01, rounding = 1e-5;

// The channels of a pixel share their random numbers, so their errors add up as if they were one.
double luminance_variance(vec3 variance) {
    const double deviation = luminance(glm::sqrt(glm::max(variance, vec3(0))));
    return deviation * deviation;
}

struct Tile {
    double difference = 0, variance = 0, reference = 0;
    int pixels = 0;
};

Tile sum_tile(const Image<vec3>& noisy, const Image<vec3>& variance, const Image<vec3>& reference, ivec2 corner) {
    Tile tile;
    const ivec2 end = glm::min(corner + side, reference.size);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x, ++tile.pixels) {
            const double light = luminance(reference.at(x, y));
            tile.difference += luminance(noisy.at(x, y)) - light;
            tile.variance += luminance_variance(variance.at(x, y));
            tile.reference += light;
        }
    return tile;
}
}

TileScores tile_scores(const Image<vec3>& noisy, const Image<vec3>& variance, const Image<vec3>& reference) {
    assert(noisy.size == reference.size && variance.size == reference.size);
    double mean = 0;
    for (const vec3 pixel : reference.pixels) mean += luminance(pixel) / static_cast<double>(reference.pixels.size());

    TileScores scores;
    double sum = 0, squares = 0, within = 0, precise = 0;
    for (int y = 0; y < reference.size.y; y += side)
        for (int x = 0; x < reference.size.x; x += side) {
            const Tile tile = sum_tile(noisy, variance, reference, {x, y});
            if (!(tile.reference > dark * mean * tile.pixels)) continue;
            const double rounded = rounding * tile.reference;
            const double error = std::sqrt(tile.variance), z = tile.difference / std::hypot(error, rounded);
            ++scores.tiles;
            sum += z, squares += z * z;
            within += std::abs(z) <= 3, precise += error <= wanted * tile.reference;
        }
    if (scores.tiles == 0) return scores;
    const double n = scores.tiles;
    scores.mean = sum / n;
    scores.deviation = std::sqrt(std::max(0.0, squares / n - scores.mean * scores.mean));
    scores.within_3 = within / n, scores.precise = precise / n;
    return scores;
}
}

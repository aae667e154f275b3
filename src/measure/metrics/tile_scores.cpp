// Sums over tiles, then over their scores.
#include "measure/metrics/tile_scores.h"

#include <cassert>

namespace tyndall {
namespace {
constexpr int side = 8;
constexpr double dark = 0.01, wanted = 0.01, rounding = 1e-5;

struct Tile {
    double difference = 0, variance = 0, reference = 0;
    int pixels = 0;

    double score() const { return difference / std::max(std::hypot(std::sqrt(variance), rounding * reference), 1e-30); }
    void add(const Tile& other) {
        difference += other.difference, variance += other.variance, reference += other.reference;
        pixels += other.pixels;
    }
};

Tile sum_tile(const Image<vec3>& noisy, const Image<vec3>& variance, const Image<vec3>& reference, ivec2 corner,
              int channel) {
    Tile tile;
    const ivec2 end = glm::min(corner + side, reference.size);
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x, ++tile.pixels) {
            const double light = reference.at(x, y)[channel];
            tile.difference += noisy.at(x, y)[channel] - light;
            tile.variance += variance.at(x, y)[channel];
            tile.reference += light;
        }
    return tile;
}
}

TileScores tile_scores(const Image<vec3>& noisy, const Image<vec3>& variance, const Image<vec3>& reference) {
    assert(noisy.size == reference.size && variance.size == reference.size);
    dvec3 mean(0);
    for (const vec3 pixel : reference.pixels) mean += dvec3(pixel) / static_cast<double>(reference.pixels.size());

    TileScores scores;
    double sum = 0, squares = 0, within = 0, precise = 0;
    for (int channel = 0; channel < 3; ++channel) {
        Tile shade;
        for (int y = 0; y < reference.size.y; y += side)
            for (int x = 0; x < reference.size.x; x += side) {
                const Tile tile = sum_tile(noisy, variance, reference, {x, y}, channel);
                if (!(tile.reference > dark * mean[channel] * tile.pixels)) {
                    shade.add(tile);
                    continue;
                }
                const double z = tile.score();
                ++scores.scores;
                sum += z, squares += z * z;
                within += std::abs(z) <= 3, precise += std::sqrt(tile.variance) <= wanted * tile.reference;
            }
        if (std::abs(shade.score()) > std::abs(scores.dark)) scores.dark = shade.score();
    }
    if (scores.scores == 0) return scores;
    const double n = scores.scores;
    scores.mean = sum / n;
    scores.deviation = std::sqrt(std::max(0.0, squares / n - scores.mean * scores.mean));
    scores.within_3 = within / n, scores.precise = precise / n;
    return scores;
}
}

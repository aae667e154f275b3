#include "measure/metrics/halves.h"

#include <cassert>

namespace tyndall {
namespace {
constexpr int block_side = 8;

struct Tile {
    double sum = 0, count = 0;
};
}

Estimate product_of_errors(const Image<vec3>& a1, const Image<vec3>& a2, const Image<vec3>& r1, const Image<vec3>& r2) {
    assert(a1.size == r1.size && a2.size == r2.size && a1.size == a2.size);
    const ivec2 tiles = (a1.size + block_side - 1) / block_side;
    Image<Tile> grid(tiles);
    for (int y = 0; y < a1.size.y; ++y)
        for (int x = 0; x < a1.size.x; ++x) {
            const dvec3 e1 = dvec3(a1.at(x, y)) - dvec3(r1.at(x, y)), e2 = dvec3(a2.at(x, y)) - dvec3(r2.at(x, y));
            const double product = glm::dot(e1, e2);
            Tile& tile = grid.at(x / block_side, y / block_side);
            if (std::isfinite(product)) tile.sum += product, tile.count += 3;
        }

    double sum = 0, count = 0;
    int used = 0;
    for (const Tile& tile : grid.pixels) sum += tile.sum, count += tile.count, used += tile.count > 0;
    const double mean = sum / count;

    // Standard error of a ratio of sums over independent tiles (Cochran 1977, cluster sampling).
    double squares = 0;
    for (const Tile& tile : grid.pixels) squares += std::pow(tile.sum - mean * tile.count, 2);
    const double correction = used / (used - 1.0);
    return {mean, used < 2 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(correction * squares) / count};
}
}

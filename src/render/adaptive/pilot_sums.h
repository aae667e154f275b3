// Squared errors of candidates, added up over the pixels of a pilot's tiles.
#pragma once
#include "render/adaptive/pilot.h"

#include <cmath>
#include <span>

namespace tyndall {
enum Product { of_integrator, of_sample, of_single, product_count };

// Of one layer: products of differences, as render/adaptive/pilot.h has them, summed over pixels.
struct Sums {
    double products[product_count] = {};
    double squares[product_count] = {}; // of the pixels' products
    double mean = 0, count = 0;

    void add(const Sums& other, double factor) {
        for (int k = 0; k < product_count; ++k)
            products[k] += factor * other.products[k], squares[k] += factor * factor * other.squares[k];
        mean += factor * other.mean, count += factor * other.count;
    }
    double square(Product k) const { // as a share of the squared mean
        if (std::abs(products[k]) == 0) return 0;
        return mean > 0 ? products[k] * count / (mean * mean) : infinity;
    }
};

// Of a tile. Pilot values of the truth, of a candidate, and of its single samples; layer 0 = colour, 1 = fog light.
Sums sums_of(std::span<const vec3> truth, std::span<const vec3> own, std::span<const vec3> center, size_t layer);

struct TileSums {
    std::vector<Sums> tiles; // those with a lamp come first
    size_t lamp_tiles = 0;
    double all = 0; // tiles of the picture
};

// Its bound is by jackknife over the tiles without a lamp: how far the ratio moves when one is left out. A pixel of a
// tile with one may be off by as much as it says.
SquaredError squared_error(const TileSums& sums, Product product);
}

#include "trace/fog/density_unit.h"

#include "volume/bricks/half.h"
#include "volume/bricks/sparse_volume.h"

#include <array>
#include <cmath>

namespace tyndall {
namespace {
constexpr int lowest = -126, highest = 127; // exponents of normal floats

// Calls `visit` with each positive density and how many voxels have it.
template<class Visit> void visit_densities(const SparseVolume& volume, const Visit& visit) {
    for (const Leaf& leaf : volume.leaves)
        for (const float value : leaf.values)
            if (value > 0) visit(value, 1.0);
    for (const Tile& tile : volume.tiles)
        if (tile.value > 0) visit(tile.value, voxels_in(tile));
}
}

float density_unit(const SparseVolume& volume) {
    constexpr int smallest = -10, largest = 15; // exponents that halves hold, with a precision of 0.1 % further down
    constexpr double stray = 1e-3;              // of the voxels
    std::array<double, highest - lowest + 1> counts{}; // by exponent
    double all = 0;
    visit_densities(volume, [&](float value, double voxels) {
        counts[static_cast<size_t>(std::clamp(std::ilogb(value), lowest, highest) - lowest)] += voxels, all += voxels;
    });
    int exponent = highest;
    for (double above = 0; exponent > lowest; --exponent)
        if ((above += counts[static_cast<size_t>(exponent - lowest)]) > stray * all) break;
    return all == 0 || (exponent >= smallest && exponent <= largest) ? 1 : std::ldexp(1.0f, exponent);
}

uint64_t divide_by(float unit, SparseVolume& volume) {
    double above = 0;
    for (Leaf& leaf : volume.leaves)
        for (float& value : leaf.values) above += (value /= unit) > largest_half;
    for (Tile& tile : volume.tiles)
        if ((tile.value /= unit) > largest_half) above += voxels_in(tile);
    return static_cast<uint64_t>(above);
}
}

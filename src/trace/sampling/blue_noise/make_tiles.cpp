// Run by the build: writes the tiles of trace/sampling/jitter.cpp as a header to standard output.
//
// Void and cluster (Ulichney 1993): ranks are assigned in order, each to the center of the largest void on a torus. In
// the spatio-temporal tile (Wolfe et al. 2022), points of one slice interact by their distance in the plane, points of
// one pixel by their distance in time; others do not.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {
constexpr int side = 64, reach = 9;
constexpr float sigma = 1.9f;

int wrap(int a, int size) { return (a % size + size) % size; }

// Breaks ties.
float tie_break(uint32_t x) {
    x ^= x >> 16, x *= 0x7feb352du, x ^= x >> 15, x *= 0x846ca68bu, x ^= x >> 16;
    return static_cast<float>(x >> 8) * 0x1p-24f * 1e-4f;
}

struct Tile {
    int slices;
    std::vector<float> energy;
    std::vector<int> best; // position of lowest energy in each slice, -1 = unknown

    int index(int x, int y, int z) const { return (z * side + y) * side + x; }
};

void raise(Tile& tile, int place, float amount) {
    tile.energy[place] += amount;
    int& best = tile.best[place / (side * side)];
    if (best == place) best = -1;
}

void fill(Tile& tile, int place) {
    const int x = place % side, y = place / side % side, z = place / (side * side);
    tile.best[z] = -1;
    for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i) {
            const float amount = std::exp(-static_cast<float>(i * i + j * j) / (2 * sigma * sigma));
            tile.energy[tile.index(wrap(x + i, side), wrap(y + j, side), z)] += amount;
        }
    for (int k = 1; k < tile.slices; ++k) {
        const int away = std::min(k, tile.slices - k);
        const float amount = std::exp(-static_cast<float>(away * away) / (2 * sigma * sigma));
        raise(tile, tile.index(x, y, (z + k) % tile.slices), amount);
    }
    tile.energy[place] = 1e30f;
}

int emptiest(Tile& tile) {
    int result = -1;
    for (int z = 0; z < tile.slices; ++z) {
        int& best = tile.best[z];
        if (best < 0) {
            best = z * side * side;
            for (int i = best; i < (z + 1) * side * side; ++i)
                if (tile.energy[i] < tile.energy[best]) best = i;
        }
        if (result < 0 || tile.energy[best] < tile.energy[result]) result = best;
    }
    return result;
}

void print_tile(const char* name, int slices) {
    const int count = side * side * slices;
    Tile tile{slices, std::vector<float>(count), std::vector<int>(slices, -1)};
    for (int i = 0; i < count; ++i) tile.energy[i] = tie_break(static_cast<uint32_t>(i));
    std::vector<int> rank(count);
    for (int i = 0; i < count; ++i) {
        const int place = emptiest(tile);
        rank[place] = i;
        fill(tile, place);
    }
    std::printf("inline constexpr unsigned short %s[%d] = {", name, count);
    for (int i = 0; i < count; ++i) // 16 bits hold all ranks
        std::printf("%s%lld", i ? "," : "", static_cast<long long>(rank[i]) * 65536 / count);
    std::printf("};\n");
}
}

int main() {
    std::printf("#pragma once\nnamespace tyndall {\n");
    print_tile("blue_noise_tile", 1);
    print_tile("spatiotemporal_tile", 16);
    std::printf("}\n");
    return std::ferror(stdout) ? 1 : 0;
}

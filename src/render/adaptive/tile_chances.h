// Where an image's error may be: the probability of drawing each tile of 4×4 pixels.
#pragma once
#include "render/frame/layers.h"

namespace tyndall {
struct Snapshot;
struct View;

inline constexpr size_t drawing_tiles = 32; // per drawing

struct TileChances {
    ivec2 low{0}, size{0};       // in tiles of the full image
    std::vector<double> chances; // row by row; their sum is 1
};

// A drawn tile and how many tiles of the image it stands for: in one drawing, the reciprocal of its probability of
// being drawn (Horvitz & Thompson 1952).
struct DrawnTile {
    ivec2 corner{0}; // pixels
    double chance = 1, weight = 1;
};

// Equal chances, except that tiles with visible lamps, where noise is largest, are certain to be drawn: up to half of a
// drawing.
TileChances uniform_chances(const View& view, const Snapshot& snapshot);

// Chances from what an image shows: a quarter each for noise, squared color, squared inscatter, and equal chances. An
// integrator's errors are proportional to the light, so their squares are proportional to its square.
TileChances chances_in(const Layers& picture);

// The same, with a quarter for squared differences in inscatter from another technique's image of the same pixels: what
// one of them omits may show in few tiles. Differences are summed over a tile to average out noise.
TileChances chances_between(const Layers& picture, const Layers& other);

// Draws `count` tiles, or all if there are fewer, by systematic sampling; tiles with high enough chances are certain to
// be drawn.
std::vector<DrawnTile> draw_tiles(const TileChances& chances, size_t count, uint32_t seed);
}

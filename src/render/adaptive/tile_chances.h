// Where in a picture its error may be: how likely each tile of 4×4 pixels is to be looked at.
#pragma once
#include "render/frame/layers.h"

namespace tyndall {
struct Snapshot;
struct View;

inline constexpr size_t drawing_tiles = 32; // drawn at once

struct TileChances {
    ivec2 low{0}, size{0};       // of the tiles, in tiles of the full picture
    std::vector<double> chances; // row by row; their sum is 1
};

// A tile that was drawn, and how many tiles of the picture it stands for: in one drawing, one divided by how likely it
// was to be drawn (Horvitz & Thompson 1952).
struct DrawnTile {
    ivec2 corner{0}; // pixels
    double chance = 1, stands_for = 1;
};

// All alike, but those with lamps in view, where noise is largest, are drawn for certain: up to half of a drawing.
TileChances even_chances(const View& view, const Snapshot& snapshot);

// By what a picture shows: a quarter for each of noise, light of surfaces, light of fog, and all alike. Errors of an
// integrator are shares of the light, so their squares go with its square.
TileChances chances_in(const Layers& picture);

// The same, and a quarter by where its fog light differs from that of another technique's picture of the same pixels:
// what one of them leaves out may be in few tiles. Tiles even out the noise.
TileChances chances_between(const Layers& picture, const Layers& other);

// `count` tiles, or all there are, spread evenly over the chances (systematic sampling); tiles likely enough are drawn
// for certain.
std::vector<DrawnTile> draw_tiles(const TileChances& chances, size_t count, uint32_t seed);
}

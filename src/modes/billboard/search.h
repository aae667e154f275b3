// The view from a light, and the openings it shines through.
#pragma once
#include "modes/billboard/billboard.h"
#include "modes/billboard/settings.h"
#include "scene/light.h"

namespace tyndall {
// The view from a light: an orthographic grid (sun), an octahedron (point) or a square over the cone (spot).
struct LightView {
    const Light* light = nullptr;
    int n = 0;
    vec3 corner{0}, right{0}, up{0}; // sun: lower left of the grid and its sides; spot: the sides at distance 1
    float reach = 0;                 // length of the rays

    Ray ray(int cell) const;
    vec3 place(int cell) const;                    // of a cell: on the grid's plane (sun), on the unit sphere
    int neighbour(int cell, int dx, int dy) const; // -1 = none
    float cell_size() const;                       // metres (sun), radians
};
// `level`: rows of a sun's grid follow the ground.
LightView light_view(const Light& light, const Snapshot& snapshot, int n, bool level);

inline constexpr int unlit = -1;

// What a ray of the grid meets. Outside a spot's cone all is 0.
struct Cell {
    float hit = 0;          // distance to the first surface
    float from = 0, to = 0; // first and last fog before it
    int opening = unlit;
};
std::vector<Cell> looked(const LightView& view, const Snapshot& snapshot);

// What was found, the cells of each opening in ascending order.
struct Openings {
    LightView view;
    std::vector<Cell> cells;
    std::vector<std::vector<int>> found;
    float large = 0; // number of cells above which an opening is cut up
    float open = 0;  // lit share of the grid of a sun in the open
};
Openings find_openings(const Light& light, const Snapshot& snapshot);

// Cuts an opening into `count` parts of like size.
std::vector<std::vector<int>> cut(const LightView& view, const std::vector<int>& cells, int count);
}

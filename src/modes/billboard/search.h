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
    vec3 position(int cell) const;                // of a cell: on the grid's plane (sun) or the unit sphere
    int neighbor(int cell, int dx, int dy) const; // -1 = none
    float cell_size() const;                      // meters (sun) or radians
};
// `level`: rows of a sun's grid are horizontal.
LightView light_view(const Light& light, const Snapshot& snapshot, int n, bool level);

inline constexpr int unlit = -1;

// What a ray of the grid hits; all 0 outside a spot's cone.
struct Cell {
    float hit = 0;          // distance to the first surface
    float from = 0, to = 0; // start and end of the fog in front of it
    int opening = unlit;
};
std::vector<Cell> trace_cells(const LightView& view, const Snapshot& snapshot);

// The openings found, each with its cells in ascending order.
struct Openings {
    LightView view;
    std::vector<Cell> cells;
    std::vector<std::vector<int>> found;
    float large = 0; // number of cells above which an opening is split
    float open = 0;  // lit fraction of a sun's grid in the open, else 0
};
Openings find_openings(const Light& light, const Snapshot& snapshot);

// Splits an opening into at most `count` clusters of similar extent.
std::vector<std::vector<int>> cut(const LightView& view, const std::vector<int>& cells, int count);
}

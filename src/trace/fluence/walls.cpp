#include "trace/fluence/walls.h"

#include "base/parallel.h"
#include "base/random.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr int probes = 16; // rays per cut cell
constexpr uint32_t use_probe = 0xf1e7u;

struct Cells {
    const Occluders& occluders;
    const FluenceOctants& octants;
    FluenceGrid& grid;
    std::vector<float>& difference; // scaled like the grid
    Box surfaces{};                 // their bounds, in cells
    std::vector<vec3> lit{};        // a lit point of each cell, in cells; the center if it is dark

    size_t index(ivec3 cell) const { return cell_index(grid, cell); }
    vec3 world(vec3 place) const { return grid.bounds.low + grid.cell * place; }
};

// Up to sixteen segments between pairs of points.
struct Segments {
    Occluders::ShadowRays rays;
    int count = 0;

    Segments() { std::fill(rays.active, rays.active + 16, 0); }
    void add(vec3 from, vec3 to) {
        const float length = glm::distance(from, to);
        const vec3 direction = length > 0 ? (to - from) / length : vec3(1, 0, 0);
        rays.set(static_cast<size_t>(count++), {from, direction, length});
    }
    // Whether any light passes along each.
    std::array<bool, 16> open(const Occluders& occluders) const {
        alignas(64) float passing[16] = {};
        occluders.transmission(rays, passing);
        std::array<bool, 16> result;
        for (size_t i = 0; i < 16; ++i) result[i] = passing[i] > 0;
        return result;
    }
};

// Mean position of the light in a cell's brightest octant.
vec3 lit_place(const Cells& cells, ivec3 cell) {
    const vec4* octants = &cells.octants[8 * cells.index(cell)];
    const vec4* most = std::max_element(octants, octants + 8, [](vec4 a, vec4 b) { return a.w < b.w; });
    return most->w > 0 ? vec3(*most) / most->w : vec3(cell) + 0.5f;
}

bool is_dark(const Cells& cells, ivec3 cell) {
    const float* values = &cells.grid.values[12 * cells.index(cell)];
    return !(values[0] + values[1] + values[2] > 0);
}

bool may_meet(const Cells& cells, vec3 a, vec3 b) {
    const vec3 low = glm::min(a, b), high = glm::max(a, b);
    return glm::all(glm::lessThanEqual(low, cells.surfaces.high)) &&
           glm::all(glm::greaterThanEqual(high, cells.surfaces.low));
}

// Finds the walls between the cells of a line along an axis.
void find_line(const Cells& cells, ivec3 cell, int axis) {
    const int last = cells.grid.size[axis] - 1;
    for (int first = 0; first < last; first += 16) {
        Segments segments;
        int places[16];
        for (int i = first; i < std::min(first + 16, last); ++i) {
            ivec3 one = cell, next = cell;
            one[axis] = i, next[axis] = i + 1;
            const vec3 from = cells.lit[cells.index(one)], to = cells.lit[cells.index(next)];
            if (!may_meet(cells, from, to) || (is_dark(cells, one) && is_dark(cells, next))) continue;
            places[segments.count] = i;
            segments.add(cells.world(from), cells.world(to));
        }
        if (segments.count == 0) continue;
        const std::array<bool, 16> open = segments.open(cells.occluders);
        for (int k = 0; k < segments.count; ++k) {
            cell[axis] = places[k];
            if (!open[static_cast<size_t>(k)]) cells.grid.walls[cells.index(cell)] |= 1 << axis;
        }
    }
}

bool is_cut(const Cells& cells, ivec3 cell) {
    if (cells.grid.walls[cells.index(cell)]) return true;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 before = cell;
        if (--before[axis] >= 0 && cells.grid.walls[cells.index(before)] >> axis & 1) return true;
    }
    return false;
}

// What rays from a cell's lit point to points spread over the cell hit.
struct Probed {
    int seen = 0;         // visible points
    vec3 met{0}, side{0}; // over the others: mean hit point, in cells, and sum of face normals
};

Probed probe(const Cells& cells, ivec3 cell) {
    const size_t index = cells.index(cell);
    const vec3 from = cells.world(cells.lit[index]);
    std::array<Ray, probes> rays;
    for (uint32_t k = 0; k < probes; ++k) {
        const Sample2 across = sample2(k, hash(static_cast<uint32_t>(index), use_probe));
        const vec3 place(across.x, across.y, (static_cast<float>(k) + 0.5f) / probes);
        const vec3 way = cells.world(vec3(cell) + place) - from;
        rays[k] = {from, way / std::max(glm::length(way), 1e-20f), glm::length(way)};
    }
    Hits hits;
    hits.instance.fill(-1), hits.t.fill(infinity);
    cells.occluders.closest(rays, 0, hits);
    Probed result;
    for (int k = 0; k < probes; ++k) {
        const size_t lane = static_cast<size_t>(k);
        if (hits.instance[lane] < 0) {
            ++result.seen;
            continue;
        }
        result.met += (rays[lane].at(hits.t[lane]) - cells.grid.bounds.low) / cells.grid.cell;
        result.side += cells.occluders.surface(rays[lane], hits, k).face_normal;
    }
    result.met /= static_cast<float>(std::max(probes - result.seen, 1));
    return result;
}

// Fraction of a cell's light on the side of its lit point.
float share_here(const Cells& cells, ivec3 cell) {
    const vec4* octants = &cells.octants[8 * cells.index(cell)];
    const vec3 from = cells.world(cells.lit[cells.index(cell)]);
    Segments parts;
    for (int k = 0; k < 8; ++k) parts.add(from, octants[k].w > 0 ? cells.world(vec3(octants[k]) / octants[k].w) : from);
    const std::array<bool, 16> open = parts.open(cells.occluders);
    float here = 0, all = 0;
    for (size_t k = 0; k < 8; ++k) all += octants[k].w, here += open[k] ? octants[k].w : 0;
    return all > 0 ? here / all : 1;
}

// Keeps the light of a cell on the side of its lit point, averaged over that part of the cell.
void keep_one_side(const Cells& cells, ivec3 cell) {
    const Probed probed = probe(cells, cell);
    const size_t first = 12 * cells.index(cell);
    const float more = share_here(cells, cell) * probes / static_cast<float>(std::max(probed.seen, 1));
    for (size_t i = first; i < first + 12; ++i) cells.grid.values[i] *= more, cells.difference[i] *= more;
    if (const float length = glm::length(probed.side); length > 0)
        cells.grid.cuts[cells.index(cell)] = vec4(probed.side, -glm::dot(probed.side, probed.met)) / length;
}

void for_each_cell(ivec3 size, const auto& visit) {
    parallel_for(size.x, [&](int64_t x) {
        for (int y = 0; y < size.y; ++y)
            for (int z = 0; z < size.z; ++z) visit(ivec3(static_cast<int>(x), y, z));
    });
}
}

void find_walls(const Occluders& occluders, const FluenceOctants& octants, FluenceGrid& grid,
                std::vector<float>& difference) {
    Cells cells{occluders, octants, grid, difference};
    const Box bounds = occluders.bounds();
    cells.surfaces = {(bounds.low - grid.bounds.low) / grid.cell, (bounds.high - grid.bounds.low) / grid.cell};
    cells.lit.resize(grid.values.size() / 12), grid.walls.assign(cells.lit.size(), 0);
    grid.cuts.assign(cells.lit.size(), vec4(0));
    for_each_cell(grid.size, [&](ivec3 cell) { cells.lit[cells.index(cell)] = lit_place(cells, cell); });
    for (int axis = 0; axis < 3; ++axis) {
        const int across = (axis + 1) % 3, up = (axis + 2) % 3;
        parallel_for(int64_t{grid.size[across]} * grid.size[up], [&](int64_t line) {
            ivec3 cell(0);
            cell[across] = static_cast<int>(line) / grid.size[up], cell[up] = static_cast<int>(line) % grid.size[up];
            find_line(cells, cell, axis);
        });
    }
    for_each_cell(grid.size, [&](ivec3 cell) {
        if (!is_dark(cells, cell) && is_cut(cells, cell)) keep_one_side(cells, cell);
    });
}
}

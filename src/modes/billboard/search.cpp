#include "modes/billboard/search.h"
#include "modes/billboard/settings.h"

#include <cmath>

namespace tyndall {
namespace {
constexpr float long_way = 0.2f;     // fraction of the longest path through fog above which a cell is lit
constexpr float large_share = 0.03f; // fraction of the grid's cells: larger openings are split
constexpr float open_share = 0.3f;   // fraction of a sun's grid: a larger opening is open air, with shafts from gaps
constexpr float long_gap = 0.025f;   // fraction of the rays' length: minimum depth behind a gap that makes a shaft
constexpr float gap_share = 0.001f;  // fraction of the grid's cells: larger gaps are split

// Labels connected components of lit cells; returns the cells of each opening.
std::vector<std::vector<int>> openings(const LightView& view, std::vector<Cell>& cells, float longest) {
    std::vector<std::vector<int>> found;
    for (Cell& cell : cells) cell.opening = unlit;
    const auto is_lit = [&](int i) { return cells[i].to - cells[i].from > long_way * longest; };
    for (int seed = 0; seed < static_cast<int>(cells.size()); ++seed) {
        if (cells[seed].opening != unlit || !is_lit(seed)) continue;
        std::vector<int> members{seed};
        cells[seed].opening = static_cast<int>(found.size());
        for (size_t k = 0; k < members.size(); ++k)
            for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                const int next = view.neighbor(members[k], dx, dy);
                if (next < 0 || cells[next].opening != unlit || !is_lit(next)) continue;
                cells[next].opening = static_cast<int>(found.size());
                members.push_back(next);
            }
        std::sort(members.begin(), members.end());
        found.push_back(std::move(members));
    }
    return found;
}

std::vector<std::vector<int>> openings(const LightView& view, std::vector<Cell>& cells) {
    float longest = 0.05f * view.reach; // reach: twice the scene's diagonal
    for (const Cell& cell : cells) longest = std::max(longest, cell.to - cell.from);
    return openings(view, cells, longest);
}

// Running minimum or maximum along rows, within `radius` cells.
std::vector<float> spread(const std::vector<float>& values, int n, int radius, bool smallest) {
    std::vector<float> result = values;
    for (int i = 0; i < n * n; ++i) {
        const int x = i % n, row = i - x;
        for (int k = std::max(x - radius, 0); k <= std::min(x + radius, n - 1); ++k)
            result[i] = smallest ? std::min(result[i], values[row + k]) : std::max(result[i], values[row + k]);
    }
    return result;
}

// For a sun in the open, cells in gaps between neighboring surfaces: where a morphological closing of the surfaces
// (minimum, then maximum of depth) is nearer than the cell's own depth. Their light starts at those surfaces.
std::vector<std::vector<int>> gaps(const LightView& view, std::vector<Cell>& cells) {
    std::vector<float> depth;
    for (const Cell& cell : cells) depth.push_back(cell.hit);
    const int radius = std::max(view.n / 10, 1);
    // Along rows only, so that level ground does not count as a surface beside a gap.
    const std::vector<float> closed = spread(spread(depth, view.n, radius, true), view.n, radius, false);
    for (size_t i = 0; i < cells.size(); ++i) {
        const bool between = cells[i].hit - closed[i] > long_gap * view.reach;
        cells[i].from = between ? std::max(cells[i].from, closed[i]) : cells[i].to;
    }
    return openings(view, cells, long_gap * view.reach / long_way);
}

// A sun's grid, refined around the lit cells of the first one: thin openings in a large scene get more rays.
LightView closer_view(const LightView& view, const std::vector<std::vector<int>>& found, int rays) {
    const int n = view.n;
    ivec2 low(n), high(-1);
    for (const auto& opening : found)
        for (const int cell : opening) {
            low = glm::min(low, ivec2(cell % n, cell / n));
            high = glm::max(high, ivec2(cell % n, cell / n));
        }
    low = glm::max(low - 2, ivec2(0)), high = glm::min(high + 3, ivec2(n));
    LightView closer = view;
    const vec2 from = vec2(low) / static_cast<float>(n), size = vec2(high - low) / static_cast<float>(n);
    closer.n = rays;
    closer.corner = view.corner + from.x * view.right + from.y * view.up;
    closer.right = size.x * view.right, closer.up = size.y * view.up;
    return closer;
}

float largest_share(const Openings& openings) {
    size_t largest = 0;
    for (const auto& opening : openings.found) largest = std::max(largest, opening.size());
    return static_cast<float>(largest) / static_cast<float>(openings.cells.size());
}

float area(const LightView& view) { return glm::length(view.right) * glm::length(view.up); }

void search(const Snapshot& snapshot, Openings& into) {
    into.cells = trace_cells(into.view, snapshot), into.found = openings(into.view, into.cells);
}
}

// Lloyd's k-means, initialized with farthest points.
std::vector<std::vector<int>> cut(const LightView& view, const std::vector<int>& cells, int count) {
    if (count <= 1) return {cells};
    std::vector<vec3> places;
    for (const int cell : cells) places.push_back(view.position(cell));
    std::vector<vec3> centers{places[places.size() / 2]};
    std::vector<float> away(places.size(), infinity);
    while (static_cast<int>(centers.size()) < count) {
        for (size_t i = 0; i < places.size(); ++i) {
            const vec3 off = places[i] - centers.back();
            away[i] = std::min(away[i], glm::dot(off, off));
        }
        centers.push_back(places[std::max_element(away.begin(), away.end()) - away.begin()]);
    }
    std::vector<std::vector<int>> parts;
    for (int round = 0; round < 4; ++round) {
        parts.assign(centers.size(), {});
        std::vector<vec3> sums(centers.size(), vec3(0));
        for (size_t i = 0; i < places.size(); ++i) {
            const vec3 p = places[i];
            const auto nearest = std::min_element(centers.begin(), centers.end(), [&](vec3 a, vec3 b) {
                return glm::dot(p - a, p - a) < glm::dot(p - b, p - b);
            });
            parts[nearest - centers.begin()].push_back(cells[i]), sums[nearest - centers.begin()] += p;
        }
        for (size_t i = 0; i < centers.size(); ++i)
            if (!parts[i].empty()) centers[i] = sums[i] / static_cast<float>(parts[i].size());
    }
    std::erase_if(parts, [](const std::vector<int>& part) { return part.empty(); });
    return parts;
}

Openings find_openings(const Light& light, const Snapshot& snapshot) {
    // For a sun, the first pass only finds the region to refine.
    const bool sun = is_distant(light);
    constexpr int rays = 128; // across the light's grid
    const int first = sun ? (rays + 1) / 2 : rays;
    Openings result{light_view(light, snapshot, first, false), {}, {}};
    search(snapshot, result);
    result.large = large_share * static_cast<float>(result.cells.size());
    if (!sun || result.found.empty()) return result;

    const LightView wide = result.view;
    result.view = closer_view(wide, result.found, rays);
    result.large *= 4 * area(wide) / std::max(area(result.view), 1e-20f);
    search(snapshot, result);
    const float share = largest_share(result);
    if (share <= open_share) return result;

    result.open = share;
    result.view = light_view(light, snapshot, rays, true);
    result.cells = trace_cells(result.view, snapshot), result.found = gaps(result.view, result.cells);
    result.large = gap_share * static_cast<float>(result.cells.size());
    return result;
}
}

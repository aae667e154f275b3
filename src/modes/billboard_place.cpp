// Finding the openings that lights shine through.
#include "modes/billboard.h"

#include "base/parallel.h"
#include "base/random.h"
#include "modes/style.h"

#include <cmath>

namespace tyndall {
namespace {
constexpr float long_way = 0.2f;     // share of the longest way through fog that counts as lit
constexpr float large_share = 0.03f; // of the grid's cells: larger openings are cut up
constexpr float open_share = 0.3f;   // of a sun's grid: a larger opening is the open air, its shafts come by gaps
constexpr float long_gap = 0.025f;   // of the rays: the least way behind a gap that has a shaft
constexpr float gap_share = 0.001f;  // of the grid's cells: larger gaps are cut up
constexpr int unlit = -1;

// The view from a light: an orthographic grid (sun), an octahedron (point) or a square over the cone (spot).
struct LightView {
    const Light& light;
    int n = 0;
    vec3 corner{0}, right{0}, up{0}; // sun: lower left of the grid and its sides; spot: the sides at distance 1
    float reach = 0;                 // length of the rays

    Ray ray(int cell) const;
    vec3 place(int cell) const;                    // of a cell: on the grid's plane (sun), on the unit sphere
    int neighbour(int cell, int dx, int dy) const; // -1 = none
    float cell_size() const;                       // metres (sun), radians
};

vec3 octahedral_direction(float x, float y) {
    vec3 d(x, y, 1 - std::abs(x) - std::abs(y));
    if (d.z < 0) {
        const float fx = (1 - std::abs(y)) * std::copysign(1.0f, x), fy = (1 - std::abs(x)) * std::copysign(1.0f, y);
        d.x = fx, d.y = fy;
    }
    return glm::normalize(d);
}

Ray LightView::ray(int cell) const {
    const float x = (static_cast<float>(cell % n) + 0.5f) / static_cast<float>(n);
    const float y = (static_cast<float>(cell / n) + 0.5f) / static_cast<float>(n);
    if (light.kind == LightKind::sun) return {corner + x * right + y * up, light.direction, reach};
    if (light.kind == LightKind::point) return {light.position, octahedral_direction(2 * x - 1, 2 * y - 1), reach};
    const vec3 direction = light.direction + (2 * x - 1) * right + (2 * y - 1) * up;
    return {light.position, glm::normalize(direction), reach};
}

vec3 LightView::place(int cell) const {
    const Ray at = ray(cell);
    return light.kind == LightKind::sun ? at.origin : at.direction;
}

float LightView::cell_size() const {
    if (light.kind == LightKind::point) return std::sqrt(4 * pi) / static_cast<float>(n);
    const float side = std::sqrt(glm::length(right) * glm::length(up));
    return (light.kind == LightKind::sun ? side : 2 * side) / static_cast<float>(n);
}

int LightView::neighbour(int cell, int dx, int dy) const {
    int x = cell % n + dx, y = cell / n + dy;
    const bool beside = x < 0 || x >= n, above = y < 0 || y >= n;
    if (!beside && !above) return y * n + x;
    if (light.kind != LightKind::point || (beside && above)) return -1;
    // The octahedron's borders fold onto themselves.
    if (beside) x = std::clamp(x, 0, n - 1), y = n - 1 - y;
    if (above) y = std::clamp(y, 0, n - 1), x = n - 1 - x;
    return y * n + x;
}

Box shown(const Snapshot& snapshot) {
    Box box = snapshot.occluders && !snapshot.occluders->empty() ? snapshot.occluders->bounds() : snapshot.bounds;
    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    if (!fog.empty()) box.low = glm::max(box.low, fog.low), box.high = glm::min(box.high, fog.high);
    return box.empty() ? snapshot.bounds : box;
}

LightView light_view(const Light& light, const Snapshot& snapshot, int n, bool level = false) {
    LightView view{light, n};
    const Box box = shown(snapshot);
    view.reach = 2 * glm::length(snapshot.bounds.size()) + 1;
    vec3 u, v;
    make_frame(light.direction, u, v);
    if (level && std::abs(light.direction.y) < 0.99f) {
        u = glm::normalize(glm::cross(vec3(0, 1, 0), light.direction)); // rows of the grid follow the ground
        v = glm::cross(light.direction, u);
    }
    if (light.kind == LightKind::spot) {
        const float half = std::tan(std::min(light.outer_cone, 1.4f));
        view.right = half * u, view.up = half * v;
    } else if (light.kind == LightKind::sun) {
        Box flat; // the box in the light's frame
        for (int corner = 0; corner < 8; ++corner) {
            const vec3 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                         corner & 4 ? box.high.z : box.low.z);
            flat.grow(vec3(glm::dot(p, u), glm::dot(p, v), glm::dot(p, light.direction)));
        }
        const float behind = flat.low.z - 0.5f * glm::length(snapshot.bounds.size());
        view.corner = flat.low.x * u + flat.low.y * v + behind * light.direction;
        view.right = (flat.high.x - flat.low.x) * u, view.up = (flat.high.y - flat.low.y) * v;
    }
    return view;
}

struct Cell {
    float hit = 0;          // distance to the first surface
    float from = 0, to = 0; // first and last fog before it
    int opening = unlit;
};

std::vector<Cell> looked(const LightView& view, const Snapshot& snapshot) {
    std::vector<Cell> cells(static_cast<size_t>(view.n) * view.n);
    const int packets = static_cast<int>((cells.size() + 15) / 16);
    parallel_for(packets, [&](int64_t packet) {
        Ray rays[16];
        Hits hits;
        const int first = static_cast<int>(packet) * 16;
        const int count = std::min(16, static_cast<int>(cells.size()) - first);
        for (int i = 0; i < count; ++i) rays[i] = view.ray(first + i);
        if (snapshot.occluders) snapshot.occluders->closest({rays, size_t(count)}, 0, hits);
        for (int i = 0; i < count; ++i) {
            Cell& cell = cells[first + i];
            cell.hit = snapshot.occluders ? std::min(hits.t[i], view.reach) : view.reach;
            cell.from = cell.hit;
            for (const Medium& medium : snapshot.media) {
                const Interval in = clip(medium.world_bounds, rays[i].origin, rays[i].direction, {0, cell.hit});
                if (!in.empty()) cell.from = std::min(cell.from, in.low), cell.to = std::max(cell.to, in.high);
            }
            const bool in_cone = view.light.kind != LightKind::spot ||
                                 glm::dot(rays[i].direction, view.light.direction) >= std::cos(view.light.outer_cone);
            if (!in_cone) cell.from = cell.to = cell.hit = 0;
        }
    });
    return cells;
}

// Numbers the connected cells with a long way through fog; returns the cells of each opening.
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
                const int next = view.neighbour(members[k], dx, dy);
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

// Smallest or largest value within `radius` cells of the same row.
std::vector<float> spread(const std::vector<float>& values, int n, int radius, bool smallest) {
    std::vector<float> result = values;
    for (int i = 0; i < n * n; ++i) {
        const int x = i % n, row = i - x;
        for (int k = std::max(x - radius, 0); k <= std::min(x + radius, n - 1); ++k)
            result[i] = smallest ? std::min(result[i], values[row + k]) : std::max(result[i], values[row + k]);
    }
    return result;
}

// In the open, the cells between surfaces that stand next to each other before them: where the depths' morphological
// closing is nearer than they are. Their light begins at those surfaces.
std::vector<std::vector<int>> gaps(const LightView& view, std::vector<Cell>& cells) {
    std::vector<float> depth;
    for (const Cell& cell : cells) depth.push_back(cell.hit);
    const int radius = std::max(view.n / 10, 1);
    // Row by row: level ground is no surface beside a gap.
    const std::vector<float> closed = spread(spread(depth, view.n, radius, true), view.n, radius, false);
    for (size_t i = 0; i < cells.size(); ++i) {
        const bool between = cells[i].hit - closed[i] > long_gap * view.reach;
        cells[i].from = between ? std::max(cells[i].from, closed[i]) : cells[i].to;
    }
    return openings(view, cells, long_gap * view.reach / long_way);
}

// Cuts an opening into `count` parts of like size (Lloyd's k-means from far-apart seeds).
std::vector<std::vector<int>> cut(const LightView& view, const std::vector<int>& cells, int count) {
    if (count <= 1) return {cells};
    std::vector<vec3> places;
    for (const int cell : cells) places.push_back(view.place(cell));
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

// Axes of the ellipse with the second moments of the cells' places across `axis`; half widths of an even ellipse.
void fit_ellipse(const LightView& view, const std::vector<int>& cells, vec3 center, vec3 axis, BeamCard& card,
                 vec2& half) {
    vec3 u, v;
    make_frame(axis, u, v);
    float uu = 0, uv = 0, vv = 0;
    for (const int cell : cells) {
        const vec3 off = view.place(cell) - center;
        const float a = glm::dot(off, u), b = glm::dot(off, v);
        uu += a * a, uv += a * b, vv += b * b;
    }
    const float count = static_cast<float>(cells.size()), grain = view.cell_size() * view.cell_size() / 12;
    uu = uu / count + grain, vv = vv / count + grain, uv /= count;
    const float turn = 0.5f * std::atan2(2 * uv, uu - vv), c = std::cos(turn), s = std::sin(turn);
    card.across[0] = c * u + s * v, card.across[1] = c * v - s * u;
    half.x = 2 * std::sqrt(std::max(c * c * uu + 2 * c * s * uv + s * s * vv, grain));
    half.y = 2 * std::sqrt(std::max(s * s * uu - 2 * c * s * uv + c * c * vv, grain));
}

BeamCard card_of(const LightView& view, const std::vector<Cell>& cells, const std::vector<int>& opening) {
    vec3 place(0);
    double from = 0, to = 0, edge = 0;
    int edges = 0;
    for (const int i : opening) {
        place += view.place(i), from += cells[i].from, to += cells[i].to;
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            const int next = view.neighbour(i, dx, dy);
            if (next >= 0 && cells[next].opening == unlit && cells[next].hit > 0 && cells[next].hit < cells[i].hit)
                edge += cells[next].hit, ++edges;
        }
    }
    const float count = static_cast<float>(opening.size());
    BeamCard card;
    const Light& light = view.light;
    const bool sun = light.kind == LightKind::sun;
    const vec3 axis = sun ? light.direction : glm::normalize(place), center = place / count;
    // The beam begins where the surfaces around the opening are.
    const float fog = static_cast<float>(from / count), end = static_cast<float>(to / count);
    float start = fog;
    if (edges > 0) start = std::max(start, static_cast<float>(edge / edges));
    start = std::min(start, glm::mix(fog, end, 0.8f));
    const vec3 origin = sun ? center : light.position;
    card.from = origin + start * axis, card.to = origin + end * axis;
    vec2 half;
    fit_ellipse(view, opening, sun ? center : axis * glm::length(center), axis, card, half);
    const float spread = sun ? light.angle : 0, shine = light.radius;
    card.half_from = sun ? half : half * start + shine;
    card.half_to = (sun ? half : half * end + shine) + spread * (end - start);
    return card;
}

// One card over the whole cone of a spot.
BeamCard cone_card(const LightView& view, const std::vector<Cell>& cells) {
    const Light& light = view.light;
    BeamCard card;
    double sum = 0, count = 0;
    for (const Cell& cell : cells)
        if (cell.hit > 0) sum += cell.to, ++count;
    // KHR's edge, squared, is about half bright in the middle between inner and outer cone.
    const float length = static_cast<float>(sum / std::max(count, 1.0));
    const float half = std::tan(std::min(0.3f * light.inner_cone + 0.7f * light.outer_cone, 1.4f));
    make_frame(light.direction, card.across[0], card.across[1]);
    card.from = light.position, card.to = light.position + length * light.direction;
    card.half_from = vec2(std::max(light.radius, 0.005f)), card.half_to = vec2(half * length);
    return card;
}

// A sun's grid again over what the first one found lit: thin openings in a large scene get more rays.
LightView closer_view(const LightView& view, const std::vector<std::vector<int>>& found) {
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
    closer.corner = view.corner + from.x * view.right + from.y * view.up;
    closer.right = size.x * view.right, closer.up = size.y * view.up;
    return closer;
}

void place_for(const Snapshot& snapshot, int index, const BillboardSettings& settings, std::vector<BeamCard>& cards,
               float& open) {
    const Light& light = snapshot.lights[index];
    const bool blocked = light.shadows && snapshot.occluders && !snapshot.occluders->empty();
    if (settings.cards == 0 || (!blocked && light.kind != LightKind::spot)) return;
    // A sun's first look only finds out where to look closer.
    const bool sun = light.kind == LightKind::sun;
    LightView view = light_view(light, snapshot, sun ? (settings.rays + 1) / 2 : settings.rays);
    std::vector<Cell> cells = looked(view, snapshot);
    std::vector<std::vector<int>> found = openings(view, cells);
    float large = large_share * static_cast<float>(cells.size());
    if (sun && !found.empty()) {
        const LightView closer = closer_view(view, found);
        const auto area = [](const LightView& of) { return glm::length(of.right) * glm::length(of.up); };
        large *= area(view) / std::max(area(closer), 1e-20f);
        view.corner = closer.corner, view.right = closer.right, view.up = closer.up, view.n = settings.rays;
        large *= 4;
        cells = looked(view, snapshot), found = openings(view, cells);
        size_t largest = 0;
        for (const auto& opening : found) largest = std::max(largest, opening.size());
        const float share = static_cast<float>(largest) / static_cast<float>(cells.size());
        if (share > open_share) {
            const LightView level = light_view(light, snapshot, settings.rays, true);
            open = share, view.corner = level.corner, view.right = level.right, view.up = level.up;
            cells = looked(view, snapshot), found = gaps(view, cells);
            large = gap_share * static_cast<float>(cells.size());
        }
    }
    const auto add = [&](BeamCard card) {
        if (!(glm::length(card.to - card.from) > 1e-4f)) return;
        card.light = index, card.name = "beam " + std::to_string(cards.size() + 1) + " of " + light.name;
        card.seed = hash(static_cast<uint32_t>(index), static_cast<uint32_t>(cards.size()));
        cards.push_back(card);
    };
    if (light.kind == LightKind::spot) {
        size_t in_cone = 0, largest = 0;
        for (const Cell& cell : cells) in_cone += cell.hit > 0;
        for (const auto& opening : found) largest = std::max(largest, opening.size());
        if (10 * largest > 6 * in_cone) return add(cone_card(view, cells));
    }
    std::vector<std::vector<int>> parts;
    for (const auto& opening : found) {
        const int count = 1 + static_cast<int>(std::min(static_cast<float>(opening.size()) / large, 63.0f));
        const auto pieces = cut(view, opening, count);
        parts.insert(parts.end(), pieces.begin(), pieces.end());
    }
    std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    parts.resize(std::min(parts.size(), static_cast<size_t>(settings.cards)));
    for (const auto& part : parts) add(card_of(view, cells, part));
}

void place_by_hand(const Snapshot& snapshot, std::vector<BeamCard>& cards) {
    if (!snapshot.scene) return;
    for (const Billboard& billboard : snapshot.scene->billboards)
        for (size_t l = 0; l < snapshot.lights.size(); ++l) {
            if (snapshot.lights[l].name != billboard.light) continue;
            BeamCard card;
            card.name = billboard.name, card.light = static_cast<int>(l);
            card.from = billboard.from, card.to = billboard.to;
            make_frame(glm::normalize(card.to - card.from), card.across[0], card.across[1]);
            card.half_from = vec2(0.5f * billboard.width_from), card.half_to = vec2(0.5f * billboard.width_to);
            card.tint = billboard.tint * billboard.intensity;
            card.seed = hash(0xca4du, static_cast<uint32_t>(cards.size()));
            cards.push_back(card);
        }
}
}

std::vector<BeamCard> place_cards(const Snapshot& snapshot, const BillboardSettings& settings,
                                  std::vector<float>* open) {
    std::vector<BeamCard> cards;
    std::vector<float> shares(snapshot.lights.size(), 0);
    place_by_hand(snapshot, cards);
    for (size_t l = 0; l < snapshot.lights.size(); ++l)
        place_for(snapshot, static_cast<int>(l), settings, cards, shares[l]);
    if (open) *open = shares;
    return cards;
}
}

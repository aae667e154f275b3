// The view from a light, and its rays' first hits.
#include "modes/billboard/search.h"

#include "base/parallel.h"
#include "trace/occlusion/occluders.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
vec3 octahedral_direction(float x, float y) {
    vec3 d(x, y, 1 - std::abs(x) - std::abs(y));
    if (d.z < 0) {
        const float fx = (1 - std::abs(y)) * std::copysign(1.0f, x), fy = (1 - std::abs(x)) * std::copysign(1.0f, y);
        d.x = fx, d.y = fy;
    }
    return glm::normalize(d);
}

// Surfaces that end a light's beams: those that shadow it, or all surfaces for a light without shadows.
const Occluders* ends_of(const Light& light, const Snapshot& snapshot) {
    return (light.shadows ? shadow_casters(light, snapshot) : snapshot.occluders).get();
}

Box shown(const Light& light, const Snapshot& snapshot) {
    const Occluders* ends = ends_of(light, snapshot);
    Box box = ends && !ends->empty() ? ends->bounds() : snapshot.bounds;
    Box fog;
    for (const Medium& medium : snapshot.media) fog.grow(medium.world_bounds);
    if (!fog.empty()) box.low = glm::max(box.low, fog.low), box.high = glm::min(box.high, fog.high);
    return box.empty() ? snapshot.bounds : box;
}
}

Ray LightView::ray(int cell) const {
    const float x = (static_cast<float>(cell % n) + 0.5f) / static_cast<float>(n);
    const float y = (static_cast<float>(cell / n) + 0.5f) / static_cast<float>(n);
    if (is_distant(*light)) return {corner + x * right + y * up, light->direction, reach};
    if (shines_around(*light)) return {light->position, octahedral_direction(2 * x - 1, 2 * y - 1), reach};
    const vec3 direction = light->direction + (2 * x - 1) * right + (2 * y - 1) * up;
    return {light->position, glm::normalize(direction), reach};
}

vec3 LightView::position(int cell) const {
    const Ray at = ray(cell);
    return is_distant(*light) ? at.origin : at.direction;
}

float LightView::cell_size() const {
    if (shines_around(*light)) return std::sqrt(4 * pi) / static_cast<float>(n);
    const float side = std::sqrt(glm::length(right) * glm::length(up));
    return (is_distant(*light) ? side : 2 * side) / static_cast<float>(n);
}

int LightView::neighbor(int cell, int dx, int dy) const {
    int x = cell % n + dx, y = cell / n + dy;
    const bool beside = x < 0 || x >= n, above = y < 0 || y >= n;
    if (!beside && !above) return y * n + x;
    if (!shines_around(*light) || (beside && above)) return -1;
    // The octahedron's borders fold onto themselves.
    if (beside) x = std::clamp(x, 0, n - 1), y = n - 1 - y;
    if (above) y = std::clamp(y, 0, n - 1), x = n - 1 - x;
    return y * n + x;
}

LightView light_view(const Light& light, const Snapshot& snapshot, int n, bool level) {
    LightView view{&light, n};
    const Box box = shown(light, snapshot);
    view.reach = 2 * glm::length(snapshot.bounds.size()) + 0.1f * snapshot.extent;
    vec3 u, v;
    make_frame(light.direction, u, v);
    if (level && std::abs(light.direction.y) < 0.99f) {
        u = glm::normalize(glm::cross(vec3(0, 1, 0), light.direction)); // horizontal
        v = glm::cross(light.direction, u);
    }
    if (has_cone(light)) {
        const float half = std::tan(std::min(light.outer_cone, 1.4f));
        view.right = half * u, view.up = half * v;
    } else if (is_distant(light)) {
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

std::vector<Cell> trace_cells(const LightView& view, const Snapshot& snapshot) {
    std::vector<Cell> cells(static_cast<size_t>(view.n) * view.n);
    const Occluders* ends = ends_of(*view.light, snapshot);
    const int packets = static_cast<int>((cells.size() + 15) / 16);
    parallel_for(packets, [&](int64_t packet) {
        Ray rays[16];
        Hits hits;
        const int first = static_cast<int>(packet) * 16;
        const int count = std::min(16, static_cast<int>(cells.size()) - first);
        for (int i = 0; i < count; ++i) rays[i] = view.ray(first + i);
        if (ends) ends->closest({rays, size_t(count)}, 0, hits);
        for (int i = 0; i < count; ++i) {
            Cell& cell = cells[first + i];
            cell.hit = ends ? std::min(hits.t[i], view.reach) : view.reach;
            cell.from = cell.hit;
            for (const Medium& medium : snapshot.media) {
                const Interval<float> in = clip(medium.world_bounds, rays[i].origin, rays[i].direction, {0, cell.hit});
                if (!in.empty()) cell.from = std::min(cell.from, in.low), cell.to = std::max(cell.to, in.high);
            }
            const bool in_cone = !has_cone(*view.light) ||
                                 glm::dot(rays[i].direction, view.light->direction) >= std::cos(view.light->outer_cone);
            if (!in_cone) cell.from = cell.to = cell.hit = 0;
        }
    });
    return cells;
}
}

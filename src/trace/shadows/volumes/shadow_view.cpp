// Converts shadow volumes to products with a camera's rays. Everything is in double, relative to the eye.
#include "trace/shadows/volumes/shadow_view.h"

#include "base/random.h"

namespace tyndall {
namespace {
// Mesh corners and the light, relative to `anchor`.
struct Placed {
    const ShadowVolumes& volumes;
    dvec3 anchor;
    LightPoint light;

    dvec3 corner(uint32_t i) const { return volumes.mesh->corners[i] - anchor; }
};

Placed placed_at(const ShadowVolumes& volumes, dvec3 anchor) {
    Placed result{volumes, anchor, volumes.light};
    if (!result.light.far) result.light.at -= anchor, result.light.center -= anchor;
    return result;
}

// Scalar triple product of light, a, b and eye, positive if the eye lies to the left of a→b as seen from the light.
double start_of(const Placed& placed, const ShadowMesh::Edge& edge, const dvec3* direction) {
    const dvec3 a = placed.corner(edge.a);
    const dvec3 side = glm::cross(towards(placed.light, a), placed.corner(edge.b) - a);
    return direction ? -glm::dot(side, *direction) : -glm::dot(side, a);
}

// The eye's smallest angle, as a sine, to the planes through light and edges.
double clearance(const Placed& placed, const dvec3* direction) {
    double least = 1;
    for (const ShadowMesh::Edge& edge : placed.volumes.mesh->edges) {
        const dvec3 a = placed.corner(edge.a);
        const dvec3 side = glm::cross(towards(placed.light, a), placed.corner(edge.b) - a);
        const double size = glm::length(side) * (direction ? 1 : glm::length(a));
        if (size > 0) least = std::min(least, std::abs(start_of(placed, edge, direction)) / size);
    }
    return least;
}

// An offset, too small to be visible, that moves an eye out of the plane of a side.
dvec3 small_step(uint32_t attempt, double scale) {
    if (attempt == 0) return dvec3(0);
    const auto number = [&](uint32_t axis) { return to_unit(hash(attempt, axis, 0x51de5u)) - 0.5; };
    return 1e-9 * scale * dvec3(number(0), number(1), number(2));
}

template<class Moved> dvec3 clear_of_sides(const Moved& clearance_after, double scale) {
    constexpr double enough = 1e-12; // rounding is a thousandth of it
    dvec3 best(0);
    double most = -1;
    for (uint32_t attempt = 0; attempt < 4 && most < enough; ++attempt) {
        const dvec3 step = small_step(attempt, scale);
        const double found = clearance_after(step);
        if (found > most) most = found, best = step;
    }
    return best;
}

RayProduct corner_product(const ShadowView& view, dvec3 v) {
    if (!view.parallel) return {glm::cross(towards(view.light, dvec3(0)), v), 0};
    if (view.light.far) {
        const dvec3 normal = glm::cross(view.forward, view.light.at);
        return {-normal, glm::dot(normal, v)};
    }
    const dvec3 normal = glm::cross(v - view.light.at, view.forward);
    return {-normal, glm::dot(normal, view.light.at)};
}

RayProduct edge_product(const ShadowView& view, dvec3 a, dvec3 b) {
    const dvec3 moment = glm::cross(a, b);
    if (!view.parallel) return {moment, 0};
    return {glm::cross(view.forward, b - a), glm::dot(view.forward, moment)};
}

void set_cap(const Placed& placed, const ShadowVolumes::Cap& from, const ShadowView& view, ShadowView::Cap& cap) {
    const ShadowMesh::Triangle& triangle = placed.volumes.mesh->triangles[from.triangle];
    const dvec3 a = placed.corner(triangle.corners[0]);
    cap.normal = glm::cross(placed.corner(triangle.corners[1]) - a, placed.corner(triangle.corners[2]) - a);
    if (from.flipped) cap.normal = -cap.normal;
    cap.height = glm::dot(cap.normal, a);
    cap.dark = view.parallel || cap.height > 0, cap.opposite = true;
    for (int k = 0; k < 3; ++k) {
        cap.edges[k] = triangle.edges[k], cap.left[k] = is_left(triangle, k, from.flipped);
        const bool inside = (view.edges[cap.edges[k]].start > 0) == cap.left[k];
        cap.dark &= inside, cap.opposite &= !inside;
    }
}

ShadowView make_view(const Placed& placed, const dvec3* direction) {
    const ShadowMesh& mesh = *placed.volumes.mesh;
    ShadowView view;
    view.light = placed.light, view.anchor = placed.anchor;
    if (direction) view.parallel = true, view.forward = *direction;
    view.corners.resize(mesh.corners.size()), view.edges.resize(mesh.edges.size());
    for (uint32_t i = 0; i < mesh.corners.size(); ++i) view.corners[i] = corner_product(view, placed.corner(i));
    for (uint32_t i = 0; i < mesh.edges.size(); ++i) {
        const ShadowMesh::Edge& edge = mesh.edges[i];
        view.edges[i] = {edge.a, edge.b, start_of(placed, edge, direction),
                         edge_product(view, placed.corner(edge.a), placed.corner(edge.b))};
    }
    for (const ShadowVolumes::Side& side : placed.volumes.sides) {
        const ShadowView::Edge& edge = view.edges[side.edge];
        const dvec3 a = placed.corner(edge.a);
        const dvec3 across = glm::cross(towards(placed.light, a), placed.corner(edge.b) - a);
        view.sides.push_back(
            {side.edge, edge.start > 0 ? -side.volumes : side.volumes, {across, direction ? -glm::dot(across, a) : 0}});
    }
    view.caps.resize(placed.volumes.caps.size());
    for (size_t i = 0; i < view.caps.size(); ++i) {
        set_cap(placed, placed.volumes.caps[i], view, view.caps[i]);
        view.dark += view.caps[i].dark;
    }
    return view;
}
}

ShadowView view_from(const ShadowVolumes& volumes, dvec3 point) {
    const double scale = volumes.light.far ? 1 + glm::length(point) : 1 + glm::distance(point, volumes.light.at);
    const dvec3 step =
        clear_of_sides([&](dvec3 by) { return clearance(placed_at(volumes, point + by), nullptr); }, scale);
    return make_view(placed_at(volumes, point + step), nullptr);
}

ShadowView view_along(const ShadowVolumes& volumes, dvec3 anchor, dvec3 direction) {
    const Placed placed = placed_at(volumes, anchor);
    const dvec3 unit = glm::normalize(direction);
    const dvec3 step = clear_of_sides(
        [&](dvec3 by) {
            const dvec3 moved = unit + by;
            return clearance(placed, &moved);
        },
        1);
    const dvec3 moved = unit + step;
    return make_view(placed, &moved);
}

ShadowView view_from(const ShadowVolumes& volumes, const Camera& camera, ivec2 size, float margin) {
    ShadowView view = camera.ortho_height > 0 ? view_along(volumes, dvec3(camera.position), dvec3(camera.forward))
                                              : view_from(volumes, dvec3(camera.position));
    fill_tiles(volumes, camera, size, margin, view);
    return view;
}

int tile_of(const ShadowView& view, std::span<const vec2> positions, float margin) {
    if (positions.empty() || view.tiles.x == 0) return -1;
    vec2 middle(0);
    for (const vec2 p : positions) middle += p / static_cast<float>(positions.size());
    const ivec2 tile = glm::clamp(ivec2(glm::floor(middle / float(shadow_tile_side))), ivec2(0), view.tiles - 1);
    for (const vec2 p : positions) {
        const vec2 low = vec2(tile * shadow_tile_side) - margin, high = vec2((tile + 1) * shadow_tile_side) + margin;
        if (glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high))) return -1;
    }
    return tile.y * view.tiles.x + tile.x;
}

void place_ray(const ShadowView& view, const Ray& ray, int lane, ShadowViewRays& rays) {
    const dvec3 origin = dvec3(ray.origin) - view.anchor, direction(ray.direction);
    const double along = glm::dot(origin, direction) / glm::dot(direction, direction);
    dvec3 p = view.parallel ? origin - along * direction : direction;
    // The plane through ray and light must not be degenerate.
    const dvec3 across = view.parallel ? view.light.far ? view.forward : p - view.light.at : p;
    const dvec3 other = view.parallel ? view.light.far ? across : view.forward : towards(view.light, dvec3(0));
    const dvec3 normal = glm::cross(across, other);
    constexpr double hair = 1e-5; // below it, rounding tilts the plane by more than the eye's clearance from the sides
    if ((!view.parallel || !view.light.far) &&
        glm::dot(normal, normal) <= hair * hair * glm::dot(across, across) * glm::dot(other, other)) {
        const dvec3 axis = std::abs(other.x) < 0.5 * glm::length(other) ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        p += 2 * hair * (1e-3 + glm::length(across)) * glm::normalize(glm::cross(other, axis));
    }
    for (int k = 0; k < 3; ++k) rays.p[k][lane] = p[k];
    rays.start[lane] = along, rays.end[lane] = along + ray.t_max, rays.active |= 1u << lane;
}
}

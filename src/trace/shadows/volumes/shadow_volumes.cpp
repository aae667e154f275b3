#include "trace/shadows/volumes/shadow_volumes.h"

#include "scene/light.h"

#include <algorithm>
#include <limits>

namespace tyndall {
namespace {
bool in_ball(const ShadowMesh& mesh, const ShadowMesh::Triangle& triangle, const LightPoint& light) {
    if (light.far || !(light.radius > 0)) return false;
    for (const uint32_t corner : triangle.corners)
        if (glm::distance(mesh.corners[corner], light.center) > light.radius) return false;
    return true;
}
}

std::optional<ShadowCone> shadow_cone(const Light& light) {
    constexpr float widest = 80 * pi / 180; // wider cones exclude little
    if (!has_cone(light) || light.area || light.outer_cone > widest) return {};
    return ShadowCone{dvec3(light.position), glm::normalize(dvec3(light.direction)), double{light.outer_cone}};
}

ShadowVolumes make_shadow_volumes(std::shared_ptr<const ShadowMesh> mesh, const LightPoint& light,
                                  std::optional<ShadowCone> reach) {
    ShadowVolumes result{std::move(mesh), light, reach, {}, {}};
    const ShadowMesh& m = *result.mesh;
    std::vector<int> volumes(m.edges.size(), 0);
    for (uint32_t t = 0; t < m.triangles.size(); ++t) {
        const ShadowMesh::Triangle& triangle = m.triangles[t];
        const dvec3 a = m.corners[triangle.corners[0]];
        const dvec3 normal = glm::cross(m.corners[triangle.corners[1]] - a, m.corners[triangle.corners[2]] - a);
        const double facing = glm::dot(normal, towards(light, a));
        if (facing == 0 || in_ball(m, triangle, light)) continue;
        result.caps.push_back({t, facing < 0});
        for (int k = 0; k < 3; ++k) volumes[triangle.edges[k]] += is_left(triangle, k, facing < 0) ? 1 : -1;
    }
    for (uint32_t e = 0; e < volumes.size(); ++e)
        if (volumes[e]) result.sides.push_back({e, volumes[e]});
    return result;
}

namespace {
// Where a segment from `origin` hits a triangle, as a fraction of its length; infinite = nowhere (Möller and Trumbore
// 1997).
double hit_fraction(const ShadowMesh& mesh, const ShadowMesh::Triangle& triangle, dvec3 origin, dvec3 way) {
    constexpr double never = std::numeric_limits<double>::infinity();
    const dvec3 a = mesh.corners[triangle.corners[0]], to = origin - a;
    const dvec3 ab = mesh.corners[triangle.corners[1]] - a, ac = mesh.corners[triangle.corners[2]] - a;
    const dvec3 p = glm::cross(way, ac), q = glm::cross(to, ab);
    const double volume = glm::dot(ab, p), u = glm::dot(to, p) / volume, v = glm::dot(way, q) / volume;
    const double at = glm::dot(ac, q) / volume;
    return u >= 0 && v >= 0 && u + v <= 1 && at > 0 ? at : never; // NaN where they are parallel
}
}

LightPoint visible_point(const ShadowMesh& mesh, LightPoint center, dvec3 off) {
    // Fractions of the offset. A triangle through the center itself is passed: each side keeps its half of the points.
    constexpr double at_center = 1e-6, gap = 1e-3;
    if (off == dvec3(0)) return center;
    double end = 1;
    for (const ShadowMesh::Triangle& triangle : mesh.triangles) {
        const double at = hit_fraction(mesh, triangle, center.at, off);
        if (at > at_center && at - gap < end && !in_ball(mesh, triangle, center)) end = std::max(at - gap, 0.0);
    }
    center.at += end * off;
    return center;
}

int count_between(const ShadowVolumes& volumes, dvec3 point) {
    const ShadowMesh& m = *volumes.mesh;
    int count = 0;
    for (const ShadowVolumes::Cap& cap : volumes.caps) {
        const ShadowMesh::Triangle& triangle = m.triangles[cap.triangle];
        bool inside = true;
        for (int k = 0; k < 3 && inside; ++k) {
            const ShadowMesh::Edge edge = m.edges[triangle.edges[k]];
            const dvec3 a = m.corners[edge.a], side = glm::cross(towards(volumes.light, a), m.corners[edge.b] - a);
            inside = (glm::dot(side, point - a) >= 0) == is_left(triangle, k, cap.flipped);
        }
        if (!inside) continue;
        const dvec3 a = m.corners[triangle.corners[0]];
        const dvec3 normal = glm::cross(m.corners[triangle.corners[1]] - a, m.corners[triangle.corners[2]] - a);
        count += (glm::dot(normal, point - a) < 0) != cap.flipped;
    }
    return count;
}
}

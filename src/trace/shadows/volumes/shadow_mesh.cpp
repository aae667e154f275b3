#include "trace/shadows/volumes/shadow_mesh.h"

#include "base/random.h"
#include "scene/light.h"

#include <bit>

namespace tyndall {
namespace {
// Numbers keys in the order in which they are first seen (open addressing).
template<class Key> class Numbering {
public:
    explicit Numbering(size_t most) : slots_(std::bit_ceil(2 * most + 2), unused) {}

    uint32_t operator()(const Key& key, uint32_t key_hash) {
        size_t slot = key_hash & (slots_.size() - 1);
        for (; slots_[slot] != unused; slot = (slot + 1) & (slots_.size() - 1))
            if (keys[slots_[slot]] == key) return slots_[slot];
        keys.push_back(key);
        return slots_[slot] = static_cast<uint32_t>(keys.size() - 1);
    }

    std::vector<Key> keys;

private:
    static constexpr uint32_t unused = ~0u;
    std::vector<uint32_t> slots_;
};

// Adding 0 turns -0 into 0.
uint32_t place_hash(vec3 p) {
    return hash(std::bit_cast<uint32_t>(p.x + 0.0f), std::bit_cast<uint32_t>(p.y + 0.0f),
                std::bit_cast<uint32_t>(p.z + 0.0f));
}

bool has_area(const vec3 (&p)[3]) {
    const dvec3 normal = glm::cross(dvec3(p[1]) - dvec3(p[0]), dvec3(p[2]) - dvec3(p[0]));
    return glm::dot(normal, normal) > 0;
}
}

ShadowMesh make_shadow_mesh(const std::vector<ShadowTriangle>& triangles) {
    ShadowMesh mesh;
    Numbering<vec3> corners(3 * triangles.size());
    Numbering<std::pair<uint32_t, uint32_t>> edges(3 * triangles.size());
    for (const ShadowTriangle& t : triangles) {
        if (t.has_alpha || !has_area(t.corners)) continue;
        ShadowMesh::Triangle joined;
        for (int k = 0; k < 3; ++k) joined.corners[k] = corners(t.corners[k], place_hash(t.corners[k]));
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(joined.corners[k], joined.corners[(k + 1) % 3]);
            joined.edges[k] = edges({a, b}, hash(a, b));
        }
        mesh.triangles.push_back(joined);
    }
    mesh.corners.assign(corners.keys.begin(), corners.keys.end());
    for (const auto& [a, b] : edges.keys) mesh.edges.push_back({a, b});
    return mesh;
}

namespace {
// Distance from a point to a cone, meters; 0 inside. The half angle is at most π/2.
double distance_to_cone(dvec3 apex, dvec3 axis, double half_angle, dvec3 point) {
    const dvec3 offset = point - apex;
    const double away = glm::length(offset);
    if (!(away > 0)) return 0;
    const double beside = std::acos(std::clamp(glm::dot(offset, axis) / away, -1.0, 1.0)) - half_angle;
    return beside > 0 ? away * std::sin(std::min(beside, 0.5 * double{pi})) : 0;
}

// Whether a sphere may lie between a point of the light's sphere and what the light reaches: whether it touches the
// cone and the range, widened by the light's radius.
bool may_shadow(const Light& light, dvec3 center, double radius) {
    const double slack = radius + 1e-6 * (radius + glm::distance(center, dvec3(light.position)));
    if (glm::distance(center, dvec3(light.position)) - slack > std::max(light.range, light.radius)) return false;
    if (!has_cone(light) || light.outer_cone > pi / 2) return true;
    return distance_to_cone(dvec3(light.position), glm::normalize(dvec3(light.direction)), double{light.outer_cone},
                            center) <= slack + double{light.radius};
}

bool may_shadow(const Light& light, const ShadowMesh& mesh, const ShadowMesh::Triangle& triangle) {
    const dvec3 a = mesh.corners[triangle.corners[0]], b = mesh.corners[triangle.corners[1]],
                c = mesh.corners[triangle.corners[2]], center = (a + b + c) / 3.0;
    return may_shadow(light, center,
                      std::max({glm::distance(a, center), glm::distance(b, center), glm::distance(c, center)}));
}

// New indices of the elements kept, in the same order, which keeps the order of an edge's corners.
std::vector<uint32_t> renumbered(const std::vector<uint8_t>& kept) {
    std::vector<uint32_t> numbers(kept.size());
    for (uint32_t i = 0, next = 0; i < kept.size(); ++i) numbers[i] = kept[i] ? next++ : 0;
    return numbers;
}
}

std::shared_ptr<const ShadowMesh> mesh_in_reach(std::shared_ptr<const ShadowMesh> mesh, const Light& light) {
    if (light.area || (!has_cone(light) && std::isinf(light.range))) return mesh;
    ShadowMesh part;
    std::vector<uint8_t> corners(mesh->corners.size(), 0), edges(mesh->edges.size(), 0);
    for (const ShadowMesh::Triangle& triangle : mesh->triangles) {
        if (!may_shadow(light, *mesh, triangle)) continue;
        part.triangles.push_back(triangle);
        for (int k = 0; k < 3; ++k) corners[triangle.corners[k]] = edges[triangle.edges[k]] = 1;
    }
    if (part.triangles.size() == mesh->triangles.size()) return mesh;

    const std::vector<uint32_t> corner = renumbered(corners), edge = renumbered(edges);
    for (ShadowMesh::Triangle& triangle : part.triangles)
        for (int k = 0; k < 3; ++k)
            triangle.corners[k] = corner[triangle.corners[k]], triangle.edges[k] = edge[triangle.edges[k]];
    for (size_t i = 0; i < corners.size(); ++i)
        if (corners[i]) part.corners.push_back(mesh->corners[i]);
    for (size_t i = 0; i < edges.size(); ++i)
        if (edges[i]) part.edges.push_back({corner[mesh->edges[i].a], corner[mesh->edges[i].b]});
    return std::make_shared<const ShadowMesh>(std::move(part));
}
}

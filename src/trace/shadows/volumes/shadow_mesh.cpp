#include "trace/shadows/volumes/shadow_mesh.h"

#include "base/random.h"

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

// Adding 0 makes -0 the same place as 0.
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
}

// The list of emitting triangles, and points on them.
#include "trace/lights/emissive_triangles.h"

#include "scene/pose.h"
#include "scene/scene.h"
#include "trace/frame_cache.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

namespace tyndall {
namespace {
bool glows(const Scene& scene, const Mesh& mesh) {
    if (mesh.material < 0) return false;
    const Material& material = scene.materials[mesh.material];
    return material.alpha_mode == AlphaMode::opaque && max_component(material.emission) > 0;
}

void add_instance(const Snapshot& snapshot, int index, EmissiveTriangles& glow) {
    const Scene& scene = *snapshot.scene;
    const Instance& instance = scene.instances[index];
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (!glows(scene, mesh)) return;
    const float brightness = luminance(scene.materials[mesh.material].emission);
    const mat4 matrix = instance_matrix(scene, instance, snapshot.seconds);
    const Pose pose = pose_of(scene, instance, snapshot.seconds);
    std::vector<int>& places = glow.by_shape[index];
    places.assign(mesh.triangles.size(), -1);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto corner = [&](uint32_t vertex) { return vec3(matrix * vec4(posed_position(mesh, pose, vertex), 1)); };
        const glm::uvec3 corners = mesh.triangles[i];
        EmissiveTriangle triangle{index, static_cast<int>(i), corner(corners.x), corner(corners.y), corner(corners.z)};
        triangle.area = 0.5f * glm::length(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
        triangle.chance = triangle.area * brightness;
        if (!(triangle.chance > 0) || !std::isfinite(triangle.chance)) continue;
        places[i] = static_cast<int>(glow.triangles.size());
        glow.triangles.push_back(triangle);
    }
}

EmissiveTriangles make_emissive_triangles(const Snapshot& snapshot) {
    EmissiveTriangles glow;
    glow.by_shape.resize(snapshot.scene->instances.size());
    for (size_t i = 0; i < snapshot.scene->instances.size(); ++i) add_instance(snapshot, static_cast<int>(i), glow);
    double total = 0;
    for (const EmissiveTriangle& triangle : glow.triangles) glow.cumulative.push_back(total += triangle.chance);
    for (double& sum : glow.cumulative) sum /= total;
    for (EmissiveTriangle& triangle : glow.triangles) triangle.chance /= static_cast<float>(total);
    return glow;
}
}

std::shared_ptr<const EmissiveTriangles> emissive_triangles(const Snapshot& snapshot) {
    if (!snapshot.scene || !snapshot.occluders) return nullptr;
    const Scene& scene = *snapshot.scene;
    if (std::ranges::none_of(scene.meshes, [&](const Mesh& mesh) { return glows(scene, mesh); })) return nullptr;
    auto glow = cached(snapshot, "emissive triangles", CacheKey().add(snapshot.occluders),
                       [&] { return make_emissive_triangles(snapshot); });
    return glow->triangles.empty() ? nullptr : glow;
}

EmissivePoint pick_glow_point(const EmissiveTriangles& glow, const Occluders& surfaces, float u, vec2 v) {
    const auto found = std::ranges::upper_bound(glow.cumulative, static_cast<double>(u));
    const size_t index = std::min<size_t>(found - glow.cumulative.begin(), glow.triangles.size() - 1);
    const EmissiveTriangle& triangle = glow.triangles[index];

    // Uniform over the triangle: (1-√x, √x(1-y), √x y).
    const float root = std::sqrt(v.x);
    Hits hit;
    hit.instance[0] = triangle.instance, hit.triangle[0] = triangle.triangle;
    hit.u[0] = root * (1 - v.y), hit.v[0] = root * v.y;
    const SurfacePoint surface = surfaces.surface(Ray{}, hit, 0);
    return {surface.position, surface.face_normal, surface.emission, triangle.chance / triangle.area};
}

float glow_density(const EmissiveTriangles& glow, int instance, int triangle) {
    if (glow.by_shape[instance].empty()) return 0;
    const int index = glow.by_shape[instance][triangle];
    return index < 0 ? 0 : glow.triangles[index].chance / glow.triangles[index].area;
}
}

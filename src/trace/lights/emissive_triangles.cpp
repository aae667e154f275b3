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
    return mesh.material >= 0 && can_emit(scene.materials[mesh.material]);
}

// The highest opacity in a triangle if no texture lowers it.
float highest_opacity(const Material& material, const Mesh& mesh, glm::uvec3 corners) {
    const std::vector<float>& alphas = mesh.alphas;
    const float highest = alphas.empty() ? 1 : std::max({alphas[corners.x], alphas[corners.y], alphas[corners.z]});
    return opacity_at(material, material.alpha * highest);
}

void add_instance(const Snapshot& snapshot, int index, EmissiveTriangles& emissive) {
    const Scene& scene = *snapshot.scene;
    const Instance& instance = scene.instances[index];
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (!glows(scene, mesh)) return;
    const Material& material = scene.materials[mesh.material];
    const float brightness = luminance(material.emission);
    const mat4 matrix = instance_matrix(scene, instance, snapshot.seconds);
    const Pose pose = pose_of(scene, instance, snapshot.seconds);
    std::vector<int>& places = emissive.by_shape[index];
    places.assign(mesh.triangles.size(), -1);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto corner = [&](uint32_t vertex) { return vec3(matrix * vec4(posed_position(mesh, pose, vertex), 1)); };
        const glm::uvec3 corners = mesh.triangles[i];
        EmissiveTriangle triangle{index, static_cast<int>(i), corner(corners.x), corner(corners.y), corner(corners.z)};
        triangle.area = 0.5f * glm::length(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
        triangle.probability = triangle.area * brightness * highest_opacity(material, mesh, corners);
        if (!(triangle.probability > 0) || !std::isfinite(triangle.probability)) continue;
        places[i] = static_cast<int>(emissive.triangles.size());
        emissive.triangles.push_back(triangle);
    }
    const int casters = emission_links(snapshot, index).x;
    if (std::ranges::find(emissive.casters, casters) == emissive.casters.end()) emissive.casters.push_back(casters);
}

EmissiveTriangles make_emissive_triangles(const Snapshot& snapshot) {
    EmissiveTriangles emissive;
    emissive.by_shape.resize(snapshot.scene->instances.size());
    for (size_t i = 0; i < snapshot.scene->instances.size(); ++i) add_instance(snapshot, static_cast<int>(i), emissive);
    double total = 0;
    for (const EmissiveTriangle& triangle : emissive.triangles)
        emissive.cumulative.push_back(total += triangle.probability);
    for (double& sum : emissive.cumulative) sum /= total;
    for (EmissiveTriangle& triangle : emissive.triangles) triangle.probability /= static_cast<float>(total);
    return emissive;
}
}

CacheKey emission_key(const Snapshot& snapshot) {
    CacheKey key;
    key.add(snapshot.occluders);
    for (const ivec2 links : snapshot.emission_links) key.add(links);
    return key;
}

std::shared_ptr<const EmissiveTriangles> emissive_triangles(const Snapshot& snapshot) {
    if (!snapshot.scene || !snapshot.occluders) return nullptr;
    const Scene& scene = *snapshot.scene;
    if (std::ranges::none_of(scene.meshes, [&](const Mesh& mesh) { return glows(scene, mesh); })) return nullptr;
    auto emissive = cached(snapshot, "emissive triangles", emission_key(snapshot),
                           [&] { return make_emissive_triangles(snapshot); });
    return emissive->triangles.empty() ? nullptr : emissive;
}

EmissivePoint sample_triangles(const EmissiveTriangles& emissive, const Occluders& surfaces, float u, vec2 v) {
    const auto found = std::ranges::upper_bound(emissive.cumulative, static_cast<double>(u));
    const size_t index = std::min<size_t>(found - emissive.cumulative.begin(), emissive.triangles.size() - 1);
    const EmissiveTriangle& triangle = emissive.triangles[index];

    // Uniform over the triangle: (1-√x, √x(1-y), √x y).
    const float root = std::sqrt(v.x);
    Hits hit;
    hit.instance[0] = triangle.instance, hit.triangle[0] = triangle.triangle;
    hit.u[0] = root * (1 - v.y), hit.v[0] = root * v.y;
    const SurfacePoint surface = surfaces.surface(Ray{}, hit, 0);
    return {surface.position, surface.face_normal, surface.emission * surface.alpha,
            triangle.probability / triangle.area, triangle.instance};
}

float triangle_pdf(const EmissiveTriangles& emissive, int instance, int triangle) {
    if (emissive.by_shape[instance].empty()) return 0;
    const int index = emissive.by_shape[instance][triangle];
    return index < 0 ? 0 : emissive.triangles[index].probability / emissive.triangles[index].area;
}
}

// The triangles of a moment, and the surface at a hit.
#include "trace/occlusion/scene.h"

#include "base/io/file.h"
#include "scene/scene.h"

#include <span>

namespace tyndall {
Ray off_surface(vec3 face_normal, const Ray& ray) {
    const float side = glm::dot(face_normal, ray.direction) < 0 ? -1.0f : 1.0f, offset = shadow_offset(ray.origin);
    const vec3 step = face_normal * (side * offset);
    if (std::isinf(ray.t_max) || step == vec3(0)) return {ray.origin + step, ray.direction, ray.t_max};
    const vec3 rest = ray.direction * ray.t_max - step;
    const float length = glm::length(rest);
    if (length <= 2 * offset) return {ray.origin + step, ray.direction, 0};
    return {ray.origin + step, rest / length, length - std::max(offset - 1e-4f * length, 0.0f)};
}

namespace {
bool has_triangles(const Scene& scene, const Instance& instance) {
    return instance.mesh >= 0 && !scene.meshes[instance.mesh].triangles.empty();
}

std::shared_ptr<const OccluderSet> shared_or_made(const Scene& scene, std::vector<int> instances, double seconds,
                                                  const std::shared_ptr<const OccluderSet>& previous) {
    std::vector<Placement> placements;
    for (const int i : instances)
        placements.push_back(
            {instance_matrix(scene, scene.instances[i], seconds), pose_of(scene, scene.instances[i], seconds)});
    if (previous && previous->instances == instances && previous->placements == placements) return previous;
    if (instances.empty()) return std::make_shared<OccluderSet>();
    return make_occluder_set(scene, std::move(instances), std::move(placements));
}
}

Occluders::Occluders() : impl_(std::make_unique<Impl>()) {}
Occluders::~Occluders() = default;

std::shared_ptr<const Occluders> Occluders::make(const Scene& scene, double seconds, const Occluders* previous,
                                                 const std::vector<bool>* only) {
    std::vector<int> still, moving;
    for (int i = 0; i < static_cast<int>(scene.instances.size()); ++i)
        if (has_triangles(scene, scene.instances[i]) && (!only || (*only)[static_cast<size_t>(i)]))
            (is_moving(scene, scene.instances[i]) ? moving : still).push_back(i);
    const Impl* before = previous && previous->impl_->scene == &scene ? previous->impl_.get() : nullptr;
    std::shared_ptr<Occluders> result(new Occluders);
    result->impl_->scene = &scene;
    result->impl_->still = shared_or_made(scene, std::move(still), seconds, before ? before->still : nullptr);
    result->impl_->moving = shared_or_made(scene, std::move(moving), seconds, before ? before->moving : nullptr);
    result->impl_->by_instance.resize(scene.instances.size());
    for (const OccluderSet* set : {result->impl_->still.get(), result->impl_->moving.get()})
        for (const OccluderGeometry& geometry : set->geometries)
            result->impl_->by_instance[geometry.instance] = &geometry;
    return result;
}

bool Occluders::empty() const { return triangle_count() == 0; }
uint64_t Occluders::triangle_count() const { return impl_->still->triangles + impl_->moving->triangles; }
uint64_t Occluders::dropped() const { return impl_->still->dropped + impl_->moving->dropped; }

std::string Occluders::content() const {
    std::string bytes;
    const auto add = [&](const auto& values) {
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]);
    };
    for (const OccluderSet* set : {impl_->still.get(), impl_->moving.get()}) {
        add(set->instances);
        for (const Placement& one : set->placements)
            add(std::span(&one.matrix, 1)), add(one.pose.targets), add(one.pose.joints);
    }
    return "surfaces " + content_hash(bytes);
}

Box Occluders::bounds() const {
    Box box = impl_->still->bounds;
    box.grow(impl_->moving->bounds);
    return box;
}

bool Occluders::shares_with(const Occluders& other) const {
    return impl_->still == other.impl_->still && impl_->moving == other.impl_->moving;
}

bool Occluders::has_alpha() const { return impl_->still->has_alpha || impl_->moving->has_alpha; }

std::vector<ShadowTriangle> Occluders::shadow_triangles() const {
    constexpr uint64_t bytes_of_triangle = 250; // with what is made of these, and what is traced
    std::vector<int> instances = impl_->still->instances;
    instances.insert(instances.end(), impl_->moving->instances.begin(), impl_->moving->instances.end());
    check_triangles_fit(*impl_->scene, instances, bytes_of_triangle);
    std::vector<ShadowTriangle> result;
    result.reserve(triangle_count());
    for (const OccluderSet* set : {impl_->still.get(), impl_->moving.get()})
        for (const OccluderGeometry& geometry : set->geometries) {
            const std::vector<vec3>& at = geometry.positions;
            for (const glm::uvec3 c : geometry.traced())
                result.push_back({{at[c.x], at[c.y], at[c.z]}, geometry.passes_light()});
        }
    return result;
}

SurfacePoint Occluders::surface(const Ray& ray, const Hits& hits, int lane) const {
    const OccluderGeometry& geometry = *impl_->by_instance[hits.instance[lane]];
    const Mesh& mesh = *geometry.mesh;
    const glm::uvec3 corners = mesh.triangles[hits.triangle[lane]];
    const float u = hits.u[lane], v = hits.v[lane];
    const vec3 a = geometry.positions[corners.x], b = geometry.positions[corners.y], c = geometry.positions[corners.z];

    // Both normals are flipped toward the viewer: every surface is two-sided.
    SurfacePoint point;
    point.instance = geometry.instance;
    point.position = (1 - u - v) * a + u * b + v * c;
    point.face_normal = vec3(glm::normalize(glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a))));
    if (glm::dot(point.face_normal, ray.direction) > 0) point.face_normal = -point.face_normal;
    point.normal = point.face_normal;
    if (!mesh.normals.empty()) {
        const vec3 smooth = geometry.normal_to_world * interpolated(geometry.normals(), corners, u, v);
        const float length = glm::length(smooth);
        if (length > 0 && std::isfinite(length)) point.normal = smooth / length;
        if (glm::dot(point.normal, point.face_normal) < 0) point.normal = -point.normal;
    }

    if (!mesh.colors.empty()) point.base_color = interpolated(mesh.colors, corners, u, v);
    if (!geometry.material) return point;
    const vec2 uv = mesh.uvs.empty() ? vec2(0) : interpolated(mesh.uvs, corners, u, v);
    point.base_color *= geometry.material->base_color;
    if (geometry.base_texture) point.base_color *= vec3(sample_texture(*geometry.base_texture, uv));
    point.emission = geometry.material->emission;
    if (geometry.emission_texture) point.emission *= vec3(sample_texture(*geometry.emission_texture, uv));
    point.alpha = geometry.opacity(static_cast<uint32_t>(hits.triangle[lane]), u, v);
    return point;
}
}

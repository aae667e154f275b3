// Triangles of instances, moved to world space, checked, and built into an Embree scene.
#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "scene/scene.h"
#include "trace/occlusion/scene.h"

namespace tyndall {
namespace {
const Texture* usable_texture(const Scene& scene, int index) {
    if (index < 0 || index >= static_cast<int>(scene.textures.size())) return nullptr;
    return scene.textures[index].texels ? &scene.textures[index] : nullptr;
}

bool in_range(vec3 p) { return is_finite(p) && max_component(glm::abs(p)) <= largest_coordinate; }

bool traceable(const std::vector<vec3>& positions, size_t count, glm::uvec3 corners) {
    if (corners.x >= count || corners.y >= count || corners.z >= count) return false;
    const vec3 a = positions[corners.x], b = positions[corners.y], c = positions[corners.z];
    if (!in_range(a) || !in_range(b) || !in_range(c)) return false;
    const dvec3 area = glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
    return glm::dot(area, area) > 0;
}

// Drops triangles that cannot be traced and returns how many; the index list is copied only then.
uint64_t leave_out_bad_triangles(OccluderGeometry& geometry) {
    const std::vector<glm::uvec3>& triangles = geometry.mesh->triangles;
    const size_t corners = geometry.mesh->positions.size();
    std::vector<uint32_t> good;
    for (uint32_t i = 0; i < triangles.size(); ++i)
        if (traceable(geometry.positions, corners, triangles[i])) good.push_back(i);
    if (good.size() == triangles.size()) return 0;
    for (const uint32_t i : good) geometry.kept.push_back(triangles[i]);
    geometry.originals = std::move(good);
    return geometry.left_out = triangles.size() - geometry.kept.size();
}

OccluderGeometry placed_geometry(const Scene& scene, int index, const Placement& placement) {
    const auto& [matrix, pose] = placement;
    const Mesh& mesh = scene.meshes[scene.instances[index].mesh];
    OccluderGeometry geometry;
    geometry.mesh = &mesh;
    geometry.instance = index;
    geometry.normal_to_world = glm::transpose(glm::inverse(mat3(matrix)));
    if (mesh.material >= 0 && mesh.material < static_cast<int>(scene.materials.size())) {
        geometry.material = &scene.materials[mesh.material];
        geometry.base_texture = usable_texture(scene, geometry.material->base_texture);
        geometry.emission_texture = usable_texture(scene, geometry.material->emission_texture);
    }
    geometry.positions.reserve(mesh.positions.size() + 1);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 position = pose.empty() ? mesh.positions[i] : posed_position(mesh, pose, i);
        geometry.positions.push_back(vec3(matrix * vec4(position, 1)));
    }
    geometry.positions.push_back(vec3(0));
    for (size_t i = 0; i < mesh.normals.size() && !pose.empty(); ++i)
        geometry.posed_normals.push_back(posed_normal(mesh, pose, i));
    return geometry;
}

// Only geometry with alpha needs callbacks; all else is traced at full speed.
void set_callbacks(RTCGeometry handle, const OccluderGeometry& geometry) {
    if (geometry.masks()) rtcSetGeometryIntersectFilterFunction(handle, pass_mask_holes);
    if (geometry.passes_light()) rtcSetGeometryOccludedFilterFunction(handle, pass_light);
}

void attach(RTCDevice device, OccluderSet& set, const OccluderGeometry& geometry, uint32_t id) {
    const std::vector<glm::uvec3>& triangles = geometry.traced();
    const RTCGeometry handle = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(handle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, geometry.positions.data(), 0,
                               sizeof(vec3), geometry.positions.size() - 1);
    rtcSetSharedGeometryBuffer(handle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(glm::uvec3), triangles.size());
    rtcSetGeometryUserData(handle, const_cast<OccluderGeometry*>(&geometry));
    set_callbacks(handle, geometry);
    rtcCommitGeometry(handle);
    rtcAttachGeometryByID(set.scene, handle, id);
    rtcReleaseGeometry(handle);

    set.triangles += triangles.size();
    set.has_alpha |= geometry.masks() || geometry.blends();
    for (const glm::uvec3 corners : triangles)
        for (int k = 0; k < 3; ++k) set.bounds.grow(geometry.positions[corners[k]]);
}
}

void check_triangles_fit(const Scene& scene, const std::vector<int>& instances, uint64_t bytes_each) {
    constexpr uint64_t bytes_of_instance = 1000;
    uint64_t triangles = 0, needed = bytes_of_instance * instances.size();
    for (const int i : instances) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        triangles += mesh.triangles.size();
        needed += bytes_each * mesh.triangles.size() + sizeof(vec3) * mesh.positions.size();
    }
    const uint64_t available = available_memory();
    if (needed <= available) return;
    fail(ExitCode::out_of_memory, scene.file.string(),
         count_text(triangles, "triangle") + " in " + count_text(instances.size(), "instance") + " take about " +
             bytes_text(static_cast<double>(needed)) + " of memory, " + bytes_text(static_cast<double>(available)) +
             " are available");
}

OccluderSet::~OccluderSet() {
    if (scene) rtcReleaseScene(scene);
}

std::shared_ptr<const OccluderSet> make_occluder_set(const Scene& scene, std::vector<int> instances,
                                                     std::vector<Placement> placements) {
    constexpr uint64_t bytes_of_triangle = 100; // while Embree builds its tree; 70 afterwards
    check_triangles_fit(scene, instances, bytes_of_triangle);
    auto set = std::make_shared<OccluderSet>();
    set->geometries.resize(instances.size());
    std::vector<uint64_t> dropped(instances.size(), 0);
    parallel_for(static_cast<int64_t>(instances.size()), [&](int64_t i) {
        set->geometries[i] = placed_geometry(scene, instances[i], placements[i]);
        dropped[i] = leave_out_bad_triangles(set->geometries[i]);
    });
    for (const uint64_t count : dropped) set->dropped += count;

    const RTCDevice device = embree_device();
    set->scene = rtcNewScene(device);
    check_embree();
    rtcSetSceneFlags(set->scene, RTC_SCENE_FLAG_ROBUST);
    for (uint32_t i = 0; i < set->geometries.size(); ++i)
        if (!set->geometries[i].traced().empty()) attach(device, *set, set->geometries[i], i);
    if (set->triangles > 0) rtcCommitScene(set->scene);
    check_embree();
    set->instances = std::move(instances);
    set->placements = std::move(placements);
    return set;
}

const OccluderSet* passing_part(const Scene& scene, const OccluderSet& set) {
    std::call_once(set.sifted, [&] {
        std::vector<int> instances;
        std::vector<Placement> placements;
        for (size_t i = 0; i < set.geometries.size(); ++i)
            if (set.geometries[i].passes_light())
                instances.push_back(set.instances[i]), placements.push_back(set.placements[i]);
        if (!instances.empty()) set.passing = make_occluder_set(scene, std::move(instances), std::move(placements));
    });
    return set.passing.get();
}
}

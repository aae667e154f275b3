#include "trace/shadows/volumes/shadow_stage.h"

namespace tyndall::test {
std::vector<ShadowTriangle> triangles_of(const std::vector<Mesh>& meshes) {
    std::vector<ShadowTriangle> result;
    for (const Mesh& mesh : meshes)
        for (const glm::uvec3 t : mesh.triangles)
            result.push_back({{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]}, false});
    return result;
}

Stage stage_of(std::vector<ShadowTriangle> triangles, const LightPoint& light) {
    const auto mesh = std::make_shared<const ShadowMesh>(make_shadow_mesh(triangles));
    return {triangles, make_shadow_slices(triangles), make_shadow_volumes(mesh, light), light};
}
Stage stage_of(const std::vector<Mesh>& meshes, const LightPoint& light) {
    return stage_of(triangles_of(meshes), light);
}

int Counted::at(double t) const {
    float count = static_cast<float>(dark);
    for (const ShadowCrossing& crossing : crossings) count += crossing.t[lane] <= t ? crossing.change[lane] : 0;
    return static_cast<int>(count);
}

std::vector<Interval<double>> Counted::lit(Interval<double> range) {
    int counts[16] = {};
    Interval<double> ranges[16];
    std::vector<Interval<double>> result[16];
    counts[lane] = dark, ranges[lane] = range;
    append_lit(counts, crossings, ranges, result);
    return result[lane];
}

Counted crossings_of(const ShadowView& view, const Ray& ray, int tile) {
    ShadowViewRays rays;
    rays.tile = tile;
    place_ray(view, ray, lane, rays);
    std::vector<ShadowCrossing> found;
    find_crossings(view, rays, found);
    return {view.dark, found};
}

std::vector<Mesh> random_boxes(int count) {
    std::vector<Mesh> meshes;
    for (int i = 0; i < count; ++i) {
        const vec3 low = random_point(static_cast<uint32_t>(i), 5, {vec3(-3), vec3(2)});
        const vec3 size = random_point(static_cast<uint32_t>(i), 6, {vec3(0.1f), vec3(1.5f)});
        meshes.push_back(box_of(low, low + size));
    }
    return meshes;
}
}

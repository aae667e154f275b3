#include "trace/small_scenes.h"

#include "base/image.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "volume/bricks/bricks.h"

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall {
Phase forward_phase(float g) { return {PhaseKind::henyey_greenstein, g}; }

Medium homogeneous_medium(float extinction, Box box, const Phase& phase, vec3 albedo) {
    Medium medium;
    medium.name = "even";
    medium.optics = {vec3(extinction), albedo, phase, vec3(0)};
    medium.density.bounds = medium.world_bounds = box;
    return medium;
}

SparseVolume unit_volume(int voxels, const std::function<float(vec3)>& density) {
    SparseVolume volume;
    volume.index_to_world = glm::scale(dmat4(1), dvec3(1.0 / voxels));
    volume.index_to_world[3] = glm::dvec4(dvec3(0.5 / voxels), 1);
    volume.active_low = ivec3(0), volume.active_high = ivec3(voxels - 1);
    for (int x = 0; x < voxels; x += 8)
        for (int y = 0; y < voxels; y += 8)
            for (int z = 0; z < voxels; z += 8) {
                Leaf& leaf = volume.leaves.emplace_back(Leaf{{x, y, z}, {}});
                for (int i = 0; i < 512; ++i) {
                    const ivec3 voxel = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8);
                    leaf.values[static_cast<size_t>(i)] = density((vec3(voxel) + 0.5f) / static_cast<float>(voxels));
                }
            }
    return volume;
}

Medium medium_of(const SparseVolume& volume, float extinction) {
    Medium medium = homogeneous_medium(extinction);
    medium.name = "grid", medium.density.kind = DensityKind::bricks;
    medium.density.bricks = make_bricks(volume);
    medium.world_bounds = medium.density.bounds = medium.density.bricks->bounds;
    return medium;
}

Light sun_light(vec3 direction, float lux) {
    Light light;
    light.name = "sun", light.kind = LightKind::sun;
    light.direction = glm::normalize(direction), light.intensity = vec3(lux);
    return light;
}

Light point_light(vec3 position, float candela) {
    Light light;
    light.name = "point", light.position = position, light.intensity = vec3(candela);
    return light;
}

Light spot_light(vec3 position, vec3 direction, float candela, float inner_cone, float outer_cone) {
    Light light = point_light(position, candela);
    light.name = "spot", light.kind = LightKind::spot, light.direction = glm::normalize(direction);
    light.inner_cone = inner_cone, light.outer_cone = outer_cone;
    return light;
}

std::shared_ptr<const IesProfile> lobe_profile(double power) {
    IesFile file;
    file.horizontal = {0};
    for (int i = 0; i <= 360; ++i) {
        file.vertical.push_back(0.25 * i);
        file.candela.push_back(std::pow(std::max(std::cos(glm::radians(0.25 * i)), 0.0), power));
    }
    return make_ies_profile(file, "lobe " + std::to_string(power));
}

std::shared_ptr<const Gobo> board_gobo(int squares, int texels_each, vec3 light, vec3 dark) {
    Image<vec3> image(ivec2(squares * texels_each), dark);
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x)
            if ((x / texels_each + y / texels_each) % 2 == 0) image.at(x, y) = light;
    return make_gobo(image);
}

Light filtered_light(Light light, std::shared_ptr<const IesProfile> profile, std::shared_ptr<const Gobo> gobo) {
    auto filter = std::make_shared<LightFilter>();
    filter->direction = light.direction, filter->profile = std::move(profile), filter->gobo = std::move(gobo);
    filter->profile_axes = filter->gobo_axes = light_axes(light.direction, {0, 1, 0}, 0.3f);
    filter->gobo_half = vec2(std::tan(light.outer_cone));
    light.filter = std::move(filter);
    return light;
}

Mesh quad(vec3 corner, vec3 a, vec3 b, int material) {
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = material;
    return mesh;
}

Mesh box_of(vec3 low, vec3 high, int material) {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(
            {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
    for (const glm::uvec4 side : {glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6), glm::uvec4(0, 1, 5, 4),
                                  glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5)}) {
        mesh.triangles.push_back({side.x, side.y, side.z});
        mesh.triangles.push_back({side.x, side.z, side.w});
    }
    mesh.material = material;
    return mesh;
}

Mesh floor_of(float height, float half, int material) {
    return quad({-half, height, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, material);
}

Material lambert(vec3 base_color, vec3 emission) {
    Material material;
    material.base_color = base_color, material.emission = emission;
    return material;
}

Snapshot snapshot_of(std::vector<Medium> media, std::vector<Light> lights, vec3 ambient) {
    Snapshot snapshot;
    snapshot.media = std::move(media), snapshot.lights = std::move(lights), snapshot.ambient = ambient;
    for (const Medium& medium : snapshot.media)
        if (!std::isinf(medium.world_bounds.low.x)) snapshot.bounds.grow(medium.world_bounds);
    if (snapshot.bounds.empty()) snapshot.bounds = Box{vec3(-10), vec3(10)};
    return snapshot;
}

void add_surfaces(const Scene& scene, Snapshot& snapshot) {
    snapshot.scene = &scene;
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    snapshot.bounds.grow(snapshot.occluders->bounds());
}
}

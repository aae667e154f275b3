#include "measure/stress_volumes.h"

#include "base/random.h"

namespace tyndall {
SparseVolume unit_volume(int n, const std::function<float(vec3)>& density) {
    SparseVolume volume;
    volume.index_to_world = glm::scale(dmat4(1), dvec3(1.0 / n));
    volume.index_to_world[3] = glm::dvec4(dvec3(0.5 / n), 1);
    volume.active_low = ivec3(0), volume.active_high = ivec3(n - 1);
    for (int x = 0; x < n; x += 8)
        for (int y = 0; y < n; y += 8)
            for (int z = 0; z < n; z += 8) {
                Leaf& leaf = volume.leaves.emplace_back(Leaf{{x, y, z}, {}});
                for (int i = 0; i < 512; ++i) {
                    const ivec3 voxel = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8);
                    leaf.values[static_cast<size_t>(i)] = density((vec3(voxel) + 0.5f) / static_cast<float>(n));
                }
            }
    return volume;
}

Medium medium_of(const SparseVolume& volume, float extinction) {
    Medium medium = even_medium(extinction, everywhere());
    medium.name = "grid", medium.kind = DensityKind::bricks;
    medium.bricks = make_bricks(volume);
    medium.world_bounds = medium.bounds = medium.bricks->bounds;
    return medium;
}

StressScene looking_at(Medium medium) {
    return stress_scene({std::move(medium)}, {noon_light}, camera_from({0.6f, 0.7f, 2.6f}, vec3(0.5f)));
}

float blob(vec3 p) { return std::exp(-24 * glm::dot(p - 0.5f, p - 0.5f)); }
float roughness(vec3 p) {
    const glm::uvec3 cell(p * 16.0f);
    return std::max(0.0f, 2 * to_unit(hash(cell.x, cell.y, cell.z)) - 0.6f);
}
}

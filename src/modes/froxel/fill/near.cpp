// Light in froxels near a local light, sampled at points spread over them.
#include "base/random.h"
#include "integrate/equi_angular.h"
#include "modes/froxel/fill/light_injection.h"
#include "modes/froxel/settings.h"

namespace tyndall {
namespace {
// One line of a froxel, relative to a light near it.
struct NearLine {
    vec3 start, direction;
    float length;
    EquiAngular<float> angles;
    float width2; // cap on 1/r²: at least the size of the froxel's part that the line represents
};

size_t near_lines(const FroxelGrid& grid, const FroxelTiles& tiles, ivec2 at, int slice, const Light& light,
                  NearLine* lines) {
    const float low = grid.faces[static_cast<size_t>(slice)], high = grid.faces[static_cast<size_t>(slice) + 1];
    const float* depth = tiles.depth.data() + grid.tile_index(at) * tiles.rays();
    size_t count = 0;
    for (size_t ray = 0; ray < tiles.rays() && count < 16; ++ray) {
        if (!(depth[ray] > low)) continue;
        const vec2 pixel = grid.pixel_of(vec2(at) + tiles.offsets[ray]);
        const vec3 start = grid.point(pixel, low), step = grid.line_step(pixel), offset = light.position - start;
        const float slant = glm::length(step);
        const vec3 direction = step / slant;
        lines[count++] = {start,
                          direction,
                          slant * (std::min(high, depth[ray]) - low),
                          {glm::dot(offset, direction), glm::length(glm::cross(offset, direction))},
                          0};
    }
    const float side = froxel_width(grid, low);
    for (size_t i = 0; i < count; ++i) {
        NearLine& line = lines[i];
        line.width2 = std::max(side * side / (4 * pi * static_cast<float>(count)), light.core * light.core);
        const float nearest = line.angles.nearest, height = line.angles.height;
        line.angles = equi_angular(nearest, std::sqrt(height * height + line.width2), 0.0f, line.length);
    }
    return count;
}

// Factor on a light's intensity at a point, as arrival() of scene/light.h, with 1/r² of at most 1/width2.
float falloff_at(const Light& light, const NearLight& near, vec3 point, float width2) {
    Light unit = light;
    unit.intensity = vec3(1);
    const LightSample arriving = arrival(unit, point);
    const float reach = capped_radius(light);
    const float squared = std::max(arriving.distance * arriving.distance, reach * reach);
    return max_component(arriving.irradiance) * squared / std::max(squared, width2) * (1 - near.at(arriving.distance));
}
}

FroxelLightSample near_arrival(const FroxelScene& scene, const FroxelGrid& grid, const FroxelTiles& tiles, ivec2 at,
                               int slice, size_t light_index, uint32_t index) {
    const Light& light = scene.snapshot.lights[light_index];
    NearLine lines[16];
    const size_t count = near_lines(grid, tiles, at, slice, light, lines);
    if (count == 0) return {};

    // Points cycle through the lines, and divide each line into equal angles seen from the light.
    Occluders::ShadowRays shadow;
    alignas(64) float visible[16], weight[16];
    vec3 points[16];
    for (size_t i = 0; i < 16; ++i) {
        const NearLine& line = lines[i % count];
        const auto on_line = static_cast<float>((16 - i % count + count - 1) / count);
        const uint32_t key = hash(index, static_cast<uint32_t>(light_index), static_cast<uint32_t>(i));
        const float u = (static_cast<float>(i / count) + to_unit(key)) / on_line;
        const auto [t, stands_for] = line.angles.at(u);
        points[i] = line.start + t * line.direction;
        weight[i] = stands_for / (on_line * line.length * static_cast<float>(count));
        weight[i] *= falloff_at(light, scene.near(light_index), points[i], line.width2);

        const Ray ray = ray_to_light(light, points[i], vec2(to_unit(hash(key, 1u)), to_unit(hash(key, 2u))));
        shadow.set(i, {points[i], ray.direction, ray.t_max});
        shadow.active[i] = weight[i] > 0 ? -1 : 0, visible[i] = 1;
    }
    const auto& occluders = shadow_casters(light, scene.snapshot);
    if (occluders && scene.settings.visibility != FroxelVisibility::off) occluders->transmission(shadow, visible);

    FroxelLightSample result;
    for (size_t i = 0; i < 16; ++i) {
        const float amount = weight[i] > 0 ? weight[i] * visible[i] : 0;
        result.amount += amount, result.point += amount * points[i];
    }
    if (result.amount > 0) result.point /= result.amount;
    return result;
}
}

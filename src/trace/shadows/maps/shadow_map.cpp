// Shadow maps of local lights, and code shared by all kinds.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/shadows/maps/shadow_map.cpp"
#include <hwy/foreach_target.h>

#include "trace/shadows/maps/shadow_map.h"

#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/maps/shadow_map_simd.h"
#include "trace/snapshot.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void lit_shares_kernel(const ShadowMap& map, const float* x, const float* y, const float* z, float* share) {
    store(lit_fraction16(map, {load(x), load(y), load(z)}), share);
}
void texel_sizes_kernel(const ShadowMap& map, const float* x, const float* y, const float* z, float* size) {
    const TexelCoords coords = texel_coords(map, map_coordinates(map, {load(x), load(y), load(z)}));
    store(zero_unless(coords.mapped, coords.texel), size);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(lit_shares_kernel);
HWY_EXPORT(texel_sizes_kernel);

namespace {
constexpr float widest_cone = 70 * pi / 180; // half angle of a spot with a single image

// A single image of a spot's cone, or the six of a cube.
void fit_tangents(const Light& light, const ShadowMapOptions& options, ShadowMap& map) {
    const bool cube = shines_around(light) || light.outer_cone > widest_cone;
    map.projection = cube ? LightProjection::all_around : LightProjection::perspective;
    map.position = light.position;
    float half = 1;
    if (!cube) {
        vec3 u, v;
        make_frame(light.direction, u, v);
        map.world_to_map = glm::transpose(mat3(u, v, light.direction));
        half = std::max(std::tan(light.outer_cone), 1e-4f);
    }
    const int size = options.resolution, spare = 3;
    const float scale = static_cast<float>(size - 2 * spare) / (2 * half);
    const size_t texels = static_cast<size_t>(size) * static_cast<size_t>(size);
    for (size_t i = 0; i < (cube ? 6 : 1); ++i)
        map.images.push_back({ivec2(size), i * texels, vec2(scale), vec2(0.5f * static_cast<float>(size))});
}
}

ShadowMap fitted_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                            const ShadowMapOptions& options) {
    ShadowMap map;
    map.pcf = options.pcf, map.bias = options.bias;
    const auto& occluders = shadow_casters(light, snapshot);
    if (!occluders) return map;
    if (!is_distant(light)) {
        fit_tangents(light, options, map);
        return map;
    }
    const vec3 upward = std::abs(light.direction.y) < 0.999f ? vec3(0, 1, 0) : vec3(0, 0, 1);
    const vec3 u = glm::normalize(glm::cross(upward, light.direction));
    map.world_to_map = glm::transpose(mat3(u, glm::cross(light.direction, u), light.direction));
    fit_cascades(view, snapshot, occluders->bounds(), options, map);
    return map;
}

ShadowMap make_shadow_map(const View& view, const Snapshot& snapshot, const Light& light,
                          const ShadowMapOptions& options) {
    ShadowMap map = fitted_shadow_map(view, snapshot, light, options);
    if (!map.empty()) fill_shadow_map(view, snapshot, light, map);
    return map;
}

float texel_size(const ShadowMap& map, vec3 point) {
    if (map.empty()) return 0;
    alignas(64) float x[16], y[16], z[16], size[16];
    std::fill_n(x, 16, point.x), std::fill_n(y, 16, point.y), std::fill_n(z, 16, point.z);
    HWY_DYNAMIC_DISPATCH(texel_sizes_kernel)(map, x, y, z, size);
    return size[0];
}

void lit_fractions(const ShadowMap& map, const float* x, const float* y, const float* z, float* share) {
    HWY_DYNAMIC_DISPATCH(lit_shares_kernel)(map, x, y, z, share);
}
}
#endif

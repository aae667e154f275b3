#include "modes/map_shadows.h"
#include "modes/shadow_map/settings.h"
#include "scene/light.h"

#include "base/text.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
namespace {
constexpr float sharp_pixels = 4; // larger texels are visible

// Reports a light's largest shadow-map texel at the ends of the rays, in meters and in pixels.
void add_texels(const View& view, const ShadowMap& map, const Light& light, std::span<const Ray> rays,
                Limitations& limitations) {
    float largest = 0, pixels = 0;
    for (const Ray& ray : rays) {
        const vec3 end = ray.at(ray.t_max);
        const float texel = texel_size(map, end), depth = planar_depth(view.camera, ray, ray.t_max);
        const float height = view_height(view.camera, std::max(depth, 1e-6f));
        largest = std::max(largest, texel);
        pixels = std::max(pixels, texel * static_cast<float>(view.size.y) / height);
    }
    if (largest > 0)
        limitations.push_back({pixels > sharp_pixels ? Severity::degraded : Severity::info,
                               &limitation::coarse_texels,
                               Subject::light,
                               light.name,
                               {pixels, largest}});
}

bool has_blend(const Snapshot& snapshot) {
    return snapshot.scene && std::ranges::any_of(snapshot.scene->materials, [](const Material& material) {
               return material.alpha_mode == AlphaMode::blend;
           });
}

ShadowMapOptions shadow_map_options(const ShadowMapSettings& settings) {
    return {settings.resolution, settings.cascades, settings.pcf, settings.bias};
}
}

ShadowMaps make_shadow_maps(const View& view, const Snapshot& snapshot, const Settings& settings) {
    ShadowMaps maps;
    for (const Light& light : snapshot.lights)
        maps.push_back(cached_shadow_map(view, snapshot, light, shadow_map_options(settings.of<ShadowMapSettings>())));
    return maps;
}

void add_map_shadows(const View& view, const Snapshot& snapshot, const Settings& settings, Limitations& limitations) {
    const std::vector<Ray> rays = probing_rays(view, snapshot);
    const ShadowMapOptions options = shadow_map_options(settings.of<ShadowMapSettings>());
    for (const Light& light : snapshot.lights) {
        if (!shadow_casters(light, snapshot)) continue;
        if (is_soft(light))
            limitations.push_back({Severity::degraded, &limitation::hard_shadows, Subject::light, light.name});
        add_texels(view, fitted_shadow_map(view, snapshot, light, options), light, rays, limitations);
    }
    if (has_alpha_shadows(snapshot) && has_blend(snapshot))
        limitations.push_back({Severity::degraded, &limitation::no_partial_shadows, Subject::surfaces});
}
}

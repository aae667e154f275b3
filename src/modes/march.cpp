// The main renderer: single scattering by ray marching. Steps follow the fog, shadows are traced, light is dimmed by
// the fog it crosses.
#include "modes/limits.h"
#include "modes/march_kernel.h"
#include "modes/march_slices.h"
#include "modes/shadow_map_kernel.h"
#include "modes/style.h"
#include "modes/techniques.h"

namespace tyndall {
namespace {
void simplify(Medium& medium, const MarchSettings& settings) {
    if (!settings.phase) medium.optics.phase.kind = PhaseKind::isotropic;
    if (!settings.emission) medium.optics.emission = vec3(0);
}
}

std::vector<Limit> march_limits(const View& view, const Snapshot& snapshot, const Settings& settings) {
    const MarchSettings& march = settings.march;
    std::vector<Limit> limits;
    add_single_scattering_limits(snapshot, limits);
    for (const Medium& medium : snapshot.media)
        if (!march.heterogeneity && medium.kind == DensityKind::bricks)
            limits.push_back(
                {Severity::wrong, "medium " + medium.name, "march.heterogeneity is off: drawn as even fog"});
    for (const Light& light : snapshot.lights)
        if (march.visibility == Visibility::off && light.shadows)
            limits.push_back({Severity::wrong, "light " + light.name, "march.visibility is off: no shafts"});
    if (march.visibility == Visibility::slices && snapshot.occluders && snapshot.occluders->has_alpha())
        limits.push_back(
            {Severity::info, "march.visibility", "shadows of MASK and BLEND surfaces are sampled, not sliced"});
    if (march.visibility == Visibility::maps)
        for (Limit& limit : map_limits(view, snapshot, settings)) limits.push_back(std::move(limit));
    if (!snapshot.media.empty() && march.light == LightTransmittance::off)
        limits.push_back(
            {Severity::degraded, "lights", "march.light is off: fog does not dim the light that crosses it"});
    if (!snapshot.media.empty() && march.light == LightTransmittance::average)
        limits.push_back({Severity::degraded, "lights", "march.light is average: every point is dimmed the same"});
    for (const Material& material : snapshot.scene ? snapshot.scene->materials : std::vector<Material>{})
        if (max_component(material.emission) > 0) {
            limits.push_back({Severity::info, "material " + material.name, "glows, but lights nothing else"});
            break;
        }
    return limits;
}

Snapshot march_snapshot(const Snapshot& snapshot, const Settings& settings) {
    Snapshot result = stylised(snapshot, settings.style);
    if (!settings.march.heterogeneity) result.media = even_media(result.media);
    for (Medium& medium : result.media) simplify(medium, settings.march);
    if (!settings.march.ambient) result.ambient = vec3(0);
    return result;
}

ScatterFunction prepare_march(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    auto march = std::make_shared<March>();
    march->snapshot = march_snapshot(snapshot, settings);
    march->settings = settings.march, march->style = settings.style, march->camera = view.camera;
    for (const Light& light : march->snapshot.lights) {
        march->depths.push_back(
            make_light_depth(march->snapshot, light, settings.march.light, settings.march.light_resolution, &view));
        march->depths.back().scale = settings.style.light_depth;
        march->cones.push_back(cone_falloff(light));
        if (light.kind != LightKind::sun) march->near_points.push_back(light.position);
    }
    if (settings.march.visibility == Visibility::maps)
        march->maps = make_shadow_maps(view, march->snapshot, settings.shadow_map);
    if (settings.march.visibility != Visibility::slices)
        return [march](const RayBatch& batch, std::span<Scatter> results) { march_packet(*march, batch, results); };
    if (snapshot.occluders) march->slices = snapshot.occluders->shadow_slices();
    return [march](const RayBatch& batch, std::span<Scatter> results) { march_slices(*march, batch, results); };
}
}

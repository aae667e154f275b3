// The main renderer: single scattering by ray marching. Steps follow the fog, shadows are traced, light is dimmed by
// the fog it crosses.
#include "modes/march/march.h"

#include "integrate/style.h"
#include "modes/map_shadows.h"
#include "modes/march/exact.h"
#include "modes/march/kernel.h"
#include "modes/march/limitations.h"
#include "modes/march/settings.h"
#include "modes/mode.h"
#include "scene/scene.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Triangles beyond which shadow rays are taken instead. Slices, of soft lights, are cut anew by every ray: among
// scattered balls of 200 000 triangles they take seven times as long as 28 shadow rays. Volumes, of others, are made
// once.
constexpr uint64_t max_sliced = 200'000, max_with_volumes = 2'000'000;
}

ShadowsBy shadows_by(const Light& light, const Occluders& occluders) {
    const uint64_t most = is_soft(light) ? max_sliced : max_with_volumes;
    if (occluders.has_alpha() || occluders.triangle_count() > most) return ShadowsBy::rays;
    return is_soft(light) ? ShadowsBy::slices : ShadowsBy::volumes;
}

namespace {
// Steps inside lit stretches. Shadows are exact, of one point of each light for a ray; but sampled by rays at every
// step where surfaces have alpha, or are too many.
ScatterFunction prepare_slices(const View& view, const Snapshot& snapshot, const Settings& settings) {
    auto fog = std::make_shared<SingleScattering>();
    const MarchSettings& march = settings.march;
    fog->snapshot = with_terms(stylised(snapshot, settings.style), settings.terms), fog->style = settings.style;
    fog->nodes = march.nodes, fog->light_points = settings.terms.light_points;
    fog->opaque = march.min_transmittance > 0 ? -std::log(march.min_transmittance) : infinity;
    const auto by = [&](const Light& light) { return shadows_by(light, *snapshot.occluders); };
    add_lights(view, settings.terms.light, settings.terms.light_resolution, by, *fog);
    std::vector<Light> sampled; // lights that the steps have to find the shadows of
    for (size_t i = 0; i < fog->shadows.size(); ++i)
        if (fog->shadows[i].by == ShadowsBy::rays) sampled.push_back(fog->snapshot.lights[i]);
    fog->sampled = has_grid(fog->snapshot) || !sampled.empty();
    if (fog->sampled) fog->rule = march_steps(march, std::move(sampled));
    fog->fluence = cached_fluence(fog->snapshot, settings.fluence, view.seed);
    return [fog](const RayBatch& batch, std::span<Scatter> results) { single_scattering_packet(*fog, batch, results); };
}
}

ScatterFunction prepare_march(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    if (settings.march.visibility == Visibility::intervals) return prepare_slices(view, snapshot, settings);
    auto march = std::make_shared<March>();
    march->snapshot = with_terms(stylised(snapshot, settings.style), settings.terms);
    march->settings = settings.march, march->light_points = settings.terms.light_points, march->style = settings.style,
    march->camera = view.camera;
    for (const Light& light : march->snapshot.lights) {
        march->depths.push_back(
            make_light_depth(march->snapshot, light, settings.terms.light, settings.terms.light_resolution, &view));
        march->depths.back().scale = settings.style.light_depth;
        march->cones.push_back(cone_falloff(light));
    }
    march->steps = march_steps(settings.march, march->snapshot.lights);
    march->fluence = cached_fluence(march->snapshot, settings.fluence, view.seed);
    if (settings.march.visibility == Visibility::maps) march->maps = make_shadow_maps(view, march->snapshot, settings);
    if (settings.march.visibility != Visibility::exact)
        return [march](const RayBatch& batch, std::span<Scatter> results) { march_packet(*march, batch, results); };
    if (snapshot.occluders) march->slices = snapshot.occluders->shadow_slices();
    return [march](const RayBatch& batch, std::span<Scatter> results) { march_exact(*march, batch, results); };
}

Mode march_mode() {
    return {.name = "march",
            .summary = "ray marching between exact shadow boundaries: the main renderer",
            .use = "final frames, and any scene until another mode is measured to be better",
            .accuracy = Accuracy::single_scattering,
            .surfaces = Surfaces::shared,
            .limitations = march_limitations,
            .prepare = prepare_march,
            .append_rows = append_march_rows,
            .set_quality = set_march_quality,
            .rungs = march_rungs,
            .also_reads = "shadow_map", // with march.visibility=maps
            .color = "#0072B2",
            .adds_fluence = true,
            .samples_soft_lights = true};
}
}

// The main renderer: single scattering by ray marching with shadows, attenuation of light by fog and steps adapted to
// the fog, plus cached multiple scattering.
#include "integrate/lights/field_light.h"
#include "integrate/lights/fire_lamps.h"
#include "integrate/lights/mesh_lamps.h"
#include "integrate/lights/path_lights.h"
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
ShadowMethod shadow_method(const View& view, Visibility visibility, const Light& light, const Occluders& occluders,
                           bool room) {
    switch (visibility) {
    case Visibility::off:
        return ShadowMethod::none;
    case Visibility::rays:
        return ShadowMethod::rays;
    case Visibility::maps:
        return ShadowMethod::maps;
    case Visibility::intervals:
        return exact_shadows(view, light, occluders, room);
    case Visibility::exact:
        return ShadowMethod::slices;
    }
    return ShadowMethod::none;
}

// Sets the step rule: steps resolve lights whose shadows are sampled by rays or, with `all`, every light.
void add_steps(const MarchSettings& march, bool all, SingleScattering& fog) {
    std::vector<Light> lights;
    for (size_t i = 0; i < fog.shadows.size(); ++i)
        if (all || fog.shadows[i].by == ShadowMethod::rays) lights.push_back(fog.snapshot.lights[i]);
    fog.sampled = has_grid(fog.snapshot) || !lights.empty();
    fog.rule = march_steps(march, std::move(lights));
}

// Cached multiple scattering of all light; that of fire and emissive surfaces scatters further as if from lamps.
std::shared_ptr<const FluenceGrid> fluence_of(const View& view, const Snapshot& snapshot, const Settings& settings) {
    if (settings.fluence.orders < 2) return nullptr;
    Snapshot lit = with_mesh_lamps(with_fire_lamps(snapshot), settings.style, settings.terms.emission);
    take_fields(lit, settings.style, view.camera);
    return cached_fluence(lit, settings.fluence, view.seed);
}
}

ScatterFunction prepare_march(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    auto fog = std::make_shared<SingleScattering>();
    const MarchSettings& march = settings.march;
    const bool intervals = march.visibility == Visibility::intervals, exact = march.visibility == Visibility::exact;
    fog->snapshot = with_terms(stylized(snapshot, settings.style), settings.terms), fog->style = settings.style;
    const bool shadows = march.visibility != Visibility::off;
    const auto scattering =
        scattering_fog(fog->snapshot, settings.style, settings.terms, view.camera, march.min_transmittance);
    std::vector<PathLight> sampled;
    append_fire_light(fog->snapshot, scattering, shadows, sampled);
    if (settings.terms.emission) append_mesh_light(fog->snapshot, scattering, shadows, sampled);
    append_environment_light(fog->snapshot, scattering, shadows, sampled);
    fog->fluence = fluence_of(view, fog->snapshot, settings);
    FieldLight fields = take_fields(fog->snapshot, settings.style, view.camera);
    take_area_lights(fog->snapshot, scattering, shadows, sampled);
    fog->nodes = march.nodes, fog->light_points = settings.terms.light_points;
    fog->opaque = fields.opaque = march.min_transmittance > 0 ? -std::log(march.min_transmittance) : infinity;
    if (exact) fog->fields = std::move(fields.fields), fields.fields.clear();
    const bool room = intervals && has_room_for_volumes(view, fog->snapshot);
    const auto by = [&](const Light& light) {
        return shadow_method(view, march.visibility, light, *shadow_casters(light, snapshot), room);
    };
    add_lights(view, settings.terms.light, settings.terms.light_resolution, by, *fog);
    add_steps(march, !intervals && !exact, *fog);
    if (march.visibility == Visibility::maps) {
        const ShadowMaps maps = make_shadow_maps(view, fog->snapshot, settings);
        for (size_t i = 0; i < maps.size(); ++i) fog->shadows[i].map = maps[i];
    }
    ScatterFunction scatter = [fog, intervals, exact](const RayBatch& batch, std::span<Scatter> results) {
        if (intervals) return single_scattering_packet(*fog, batch, results);
        if (exact) return march_exact(*fog, batch, results);
        march_packet(*fog, batch, results);
    };
    return with_path_lights(scattering, std::move(sampled), with_field_light(std::move(fields), std::move(scatter)));
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

// Shadow volumes: exact shafts without noise.
#include "integrate/lights/field_light.h"
#include "integrate/lights/lamps.h"
#include "integrate/single_scattering/single_scattering.h"
#include "integrate/style.h"
#include "modes/lens_fog.h"
#include "modes/mode.h"
#include "modes/shadow_volume/limitations.h"
#include "modes/shadow_volume/settings.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
bool samples_fog(const Snapshot& snapshot, const ShadowVolumeSettings& settings) {
    return settings.fog == ShadowFog::sampled || (settings.fog == ShadowFog::automatic && has_grid(snapshot));
}

namespace {
float half_diagonal(const Box& scene) {
    const float length = 0.5f * glm::distance(scene.low, scene.high);
    return std::isfinite(length) && length > 0 ? length : 1;
}
}

ScatterFunction prepare_shadow_volume(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    auto frame = std::make_shared<SingleScattering>();
    const ShadowVolumeSettings& own = settings.of<ShadowVolumeSettings>();
    frame->snapshot = with_lamps(snapshot, settings.style, settings.terms);
    frame->style = settings.style;
    FieldLight fields = take_fields(frame->snapshot, settings.style, view.camera);
    frame->nodes = own.nodes, frame->steps = own.steps;
    if (own.draw == ShadowDraw::shells)
        frame->shells = {own.shell_length > 0 ? own.shell_length : half_diagonal(snapshot.bounds), own.shell_intensity};
    frame->sampled = samples_fog(frame->snapshot, own);
    if (!frame->sampled) {
        for (const Medium& medium : snapshot.media)
            if (medium.density.kind == DensityKind::bricks && !only_emits(medium.optics))
                frame->heterogeneous.push_back(medium.world_bounds);
        frame->snapshot.media = homogeneous_media(frame->snapshot.media);
    }
    // Slices give the same result, but more slowly.
    const bool room = frame->shells || has_room_for_views(frame->snapshot, [](const Light&) { return 1; });
    const auto by = [room](const Light&) { return room ? ShadowMethod::volumes : ShadowMethod::slices; };
    add_lights(view, without_froxels(settings.terms.light), settings.terms.light_resolution, by, *frame);
    ScatterFunction scatter = [frame](const RayBatch& batch, std::span<Scatter> results) {
        single_scattering_packet(*frame, batch, results);
    };
    scatter = with_lamps_as_emission(snapshot.lights.size(), frame->snapshot.lights.size(), std::move(scatter));
    return with_field_light(std::move(fields), through_middle(view, std::move(scatter)));
}

Mode shadow_volume_mode() {
    return {.name = "shadow-volume",
            .summary = "shadow volumes extruded from silhouettes; fog integrated exactly where it is lit: no noise",
            .use = "a sun through gaps, without noise",
            .accuracy = Accuracy::homogeneous,
            .surfaces = Surfaces::shared,
            .limitations = shadow_volume_limitations,
            .prepare = prepare_shadow_volume,
            .append_rows = append_shadow_volume_rows,
            .set_quality = set_shadow_volume_quality,
            .rungs = shadow_volume_rungs,
            .color = "#CC79A7",
            .interactive = true,
            .adapts_steps = false};
}
}

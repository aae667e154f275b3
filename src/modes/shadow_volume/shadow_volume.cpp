// Shadow volumes: exact shafts without noise.
#include "integrate/lit_fog.h"
#include "integrate/style.h"
#include "modes/limits.h"
#include "modes/mode.h"
#include "modes/shadow_volume/settings.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
bool samples_fog(const Snapshot& snapshot, const ShadowVolumeSettings& settings) {
    return settings.fog == ShadowFog::sampled || (settings.fog == ShadowFog::automatic && has_grid(snapshot));
}

float half_diagonal(const Box& scene) {
    const float length = 0.5f * glm::distance(scene.low, scene.high);
    return std::isfinite(length) && length > 0 ? length : 1;
}

void add_fog_limits(const View& view, const Snapshot& snapshot, const Settings& settings, std::vector<Limit>& limits) {
    const bool sampled = samples_fog(snapshot, settings.of<ShadowVolumeSettings>());
    for (const Medium& medium : snapshot.media) {
        const std::string where = "medium " + medium.name;
        if (medium.kind == DensityKind::bricks && !sampled)
            limits.push_back({Severity::wrong, where, "shadow_volume.fog is even: drawn at its mean density"});
    }
    if (sampled) {
        add_step_limits(view, snapshot, settings.of<ShadowVolumeSettings>().steps, "shadow_volume.steps", false,
                        limits);
        add_light_grid_limits(snapshot, settings.of<ShadowVolumeSettings>().light_resolution, limits);
    }
    add_single_scattering_limits(view, snapshot, limits);
}
}

std::vector<Limit> shadow_volume_limits(const View& view, const Snapshot& snapshot, const Settings& settings) {
    std::vector<Limit> limits;
    if (settings.of<ShadowVolumeSettings>().draw == ShadowDraw::shells)
        limits.push_back({Severity::wrong, "shadow_volume.draw",
                          "shells are a look: bright sheets where light meets shadow, not light scattered by fog"});
    add_fog_limits(view, snapshot, settings, limits);
    constexpr size_t many = 20000;
    bool shadows = false;
    for (const Light& light : snapshot.lights) {
        if (!casts(light, snapshot)) continue;
        if (is_soft(light))
            limits.push_back(
                {Severity::degraded, "light " + light.name, "drawn as a point: its shadows have no soft edges"});
        shadows = true;
        const size_t sides = kept_shadow_volumes(snapshot, light)->sides.size();
        if (sides > many)
            limits.push_back({Severity::info, "light " + light.name,
                              std::to_string(sides) + " silhouette edges: every tile of the picture tests many"});
    }
    if (shadows && snapshot.occluders->has_alpha())
        limits.push_back({Severity::wrong, "occluders",
                          "MASK and BLEND surfaces cast no shadow: silhouettes are those of whole triangles"});
    return limits;
}

ScatterFunction prepare_shadow_volume(const View& view, const Snapshot& snapshot, const Settings& settings, History*) {
    auto frame = std::make_shared<LitFog>();
    const ShadowVolumeSettings& own = settings.of<ShadowVolumeSettings>();
    frame->snapshot = stylised(snapshot, settings.style), frame->style = settings.style;
    frame->nodes = own.nodes, frame->steps = own.steps;
    if (own.draw == ShadowDraw::shells)
        frame->shells = {own.shell_length > 0 ? own.shell_length : half_diagonal(snapshot.bounds), own.shell_intensity};
    frame->sampled = samples_fog(snapshot, own);
    if (!frame->sampled) {
        for (const Medium& medium : snapshot.media)
            if (medium.kind == DensityKind::bricks) frame->uneven.push_back(medium.world_bounds);
        frame->snapshot.media = even_media(frame->snapshot.media);
    }
    const auto by = [](const Light&) { return ShadowsBy::volumes; };
    add_lights(view, LightTransmittance::grid, own.light_resolution, by, *frame);
    return [frame](const RayBatch& batch, std::span<Scatter> results) { lit_fog_packet(*frame, batch, results); };
}

Mode shadow_volume_mode() {
    return {.name = "shadow-volume",
            .summary = "silhouettes extruded away from the lights; fog integrated exactly where it is lit: no noise",
            .accuracy = Accuracy::even_fog,
            .surfaces = Surfaces::shared,
            .limits = shadow_volume_limits,
            .prepare = prepare_shadow_volume,
            .append_rows = append_shadow_volume_rows,
            .set_quality = set_shadow_volume_quality,
            .rungs = shadow_volume_rungs,
            .color = "#CC79A7",
            .interactive = true};
}
}

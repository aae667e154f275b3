// Ray march in a fixed number of steps with shadow maps: the technique of games, between exact entry and exit.
#include "integrate/style.h"
#include "modes/fog_picture.h"
#include "modes/history.h"
#include "modes/limits.h"
#include "modes/map_shadows.h"
#include "modes/mode.h"
#include "modes/picture_share.h"
#include "modes/shadow_map/kernel.h"
#include "modes/shadow_map/settings.h"
#include "scene/scene.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
constexpr float detail_voxels = 4; // of the finest detail of a noise

// Edges of light that fall between steps: of shafts, and of the glow of lamps that the picture shows.
void append_edge_limits(const View& view, const Snapshot& snapshot, const ShadowMapSettings& settings,
                        std::vector<Limit>& limits) {
    constexpr int fine = 64; // steps
    if (settings.steps >= fine || snapshot.media.empty()) return;
    for (const Light& light : snapshot.lights) {
        const std::string where = "light " + light.name, steps = std::to_string(settings.steps) + " steps a ray";
        if (casts(light, snapshot))
            limits.push_back(
                {Severity::degraded, where,
                 "shafts begin and end within one of " + steps + ": their edges show as grain (shadow_map.steps)"});
        if (light.kind == LightKind::sun) continue;
        const std::optional<vec2> at = pixel_of(view.camera, view.size, light.position);
        if (at && glm::all(glm::greaterThan(*at, vec2(0))) && glm::all(glm::lessThan(*at, vec2(view.size))))
            limits.push_back({Severity::degraded, where,
                              "is in the picture: " + steps + " are few for its glow" +
                                  (light.kind == LightKind::spot ? " and the edges of its cone" : "")});
    }
}
}

float fog_detail(std::span<const Medium> media) {
    float detail = infinity;
    for (const Medium& medium : media) {
        if (medium.kind != DensityKind::bricks) continue;
        const vec3 voxel = medium.bricks->voxel_size;
        detail = std::min(detail, detail_voxels * std::min(voxel.x, std::min(voxel.y, voxel.z)));
    }
    return detail;
}

std::vector<Limit> shadow_map_limits(const View& view, const Snapshot& snapshot, const Settings& settings) {
    // What a march cannot do this one cannot either.
    Settings like = settings;
    like.fluence.orders = 1;
    like.march.visibility = Visibility::rays, like.march.light = LightTransmittance::grid;
    std::vector<Limit> limits = main_mode().limits(view, snapshot, like);
    for (Limit& limit : map_limits(view, snapshot, settings)) limits.push_back(std::move(limit));
    add_step_limits(view, snapshot, settings.of<ShadowMapSettings>().steps, "shadow_map.steps", true, limits);
    append_edge_limits(view, snapshot, settings.of<ShadowMapSettings>(), limits);
    if (!snapshot.media.empty() && settings.of<ShadowMapSettings>().light == LightTransmittance::off)
        limits.push_back(
            {Severity::degraded, "lights", "shadow_map.light is off: fog does not dim the light that crosses it"});
    if (!snapshot.media.empty() && settings.of<ShadowMapSettings>().light == LightTransmittance::average)
        limits.push_back({Severity::degraded, "lights", "shadow_map.light is average: every point is dimmed the same"});
    return limits;
}

ScatterFunction prepare_shadow_map(const View& view, const Snapshot& snapshot, const Settings& settings,
                                   History* history) {
    auto march = std::make_shared<ShadowMapMarch>();
    march->snapshot = march_snapshot(snapshot, settings.march, settings.style);
    march->settings = settings.of<ShadowMapSettings>(), march->style = settings.style, march->camera = view.camera;
    march->detail = fog_detail(march->snapshot.media);
    march->maps = make_shadow_maps(view, march->snapshot, settings);
    for (const Light& light : march->snapshot.lights) {
        march->depths.push_back(make_light_depth(march->snapshot, light, settings.of<ShadowMapSettings>().light,
                                                 settings.march.light_resolution, &view));
        march->depths.back().scale = settings.style.light_depth;
        march->cones.push_back(cone_falloff(light));
    }
    ScatterFunction scatter = [march](const RayBatch& batch, std::span<Scatter> results) {
        march_shadow_maps(*march, batch, results);
    };
    const FogPictureOptions picture{settings.of<ShadowMapSettings>().picture, settings.of<ShadowMapSettings>().blur};
    if (history) follow(*history, view, snapshot, settings);
    if (picture.share == PictureShare::full && !picture.blur && !history) return scatter;
    return from_fog_picture(view, snapshot, picture, std::move(scatter), history);
}

Mode shadow_map_mode() {
    return {.name = "shadow-map",
            .summary = "ray march in a fixed number of steps with shadow maps",
            .accuracy = Accuracy::single_scattering,
            .surfaces = Surfaces::shared,
            .limits = shadow_map_limits,
            .prepare = prepare_shadow_map,
            .append_rows = append_shadow_map_rows,
            .set_quality = set_shadow_map_quality,
            .rungs = shadow_map_rungs,
            .color = "#009E73",
            .remembers = true,
            .interactive = true};
}
}

// Ray marching in a fixed number of steps with shadow maps, as in games, between exact entry and exit points.
#include "integrate/lights/field_light.h"
#include "integrate/lights/lamps.h"
#include "integrate/lobe_cuts.h"
#include "integrate/style.h"
#include "modes/fog_buffer.h"
#include "modes/history.h"
#include "modes/map_shadows.h"
#include "modes/mode.h"
#include "modes/resolution.h"
#include "modes/shadow_map/kernel.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shadow_map/settings.h"
#include "scene/lights/light_filter.h"
#include "scene/scene.h"
#include "volume/medium.h"

namespace tyndall {
ScatterFunction prepare_shadow_map(const View& view, const Snapshot& snapshot, const Settings& settings,
                                   History* history) {
    auto march = std::make_shared<ShadowMapMarch>();
    march->snapshot = with_lamps(snapshot, settings.style, settings.terms);
    FieldLight fields = take_fields(march->snapshot, settings.style, view.camera);
    march->settings = settings.of<ShadowMapSettings>(), march->style = settings.style, march->camera = view.camera;
    march->detail = fog_detail(march->snapshot.media);
    march->narrow_lobe = lobe_cuts(march->snapshot.media).count > 0;
    march->maps = make_shadow_maps(view, march->snapshot, settings);
    for (const Light& light : march->snapshot.lights) {
        march->depths.push_back(make_light_depth(march->snapshot, light, without_froxels(settings.terms.light),
                                                 settings.terms.light_resolution, &view));
        march->depths.back().scale = settings.style.light_depth;
        march->cones.push_back(cone_falloff(light));
        march->colored |= light.filter && has_colors(*light.filter);
    }
    ScatterFunction scatter = [march](const RayBatch& batch, std::span<Scatter> results) {
        march_shadow_maps(*march, batch, results);
    };
    scatter = with_lamps_as_emission(snapshot.lights.size(), march->snapshot.lights.size(), std::move(scatter));
    scatter = with_field_light(std::move(fields), std::move(scatter));
    const FogBufferOptions options{settings.of<ShadowMapSettings>().fog_resolution,
                                   settings.of<ShadowMapSettings>().blur};
    if (history) update_history(*history, view, snapshot, settings);
    if (options.resolution == Resolution::full && !options.blur && !history) return scatter;
    return from_fog_buffer(view, snapshot, options, std::move(scatter), history);
}

Mode shadow_map_mode() {
    return {.name = "shadow-map",
            .summary = "ray marching in a fixed number of steps with shadow maps",
            .use = "fast frames with many lamps or a wide view, down to an error of about 3 %",
            .accuracy = Accuracy::single_scattering,
            .surfaces = Surfaces::shared,
            .limitations = shadow_map_limitations,
            .prepare = prepare_shadow_map,
            .append_rows = append_shadow_map_rows,
            .set_quality = set_shadow_map_quality,
            .rungs = shadow_map_rungs,
            .color = "#009E73",
            .uses_history = true,
            .interactive = true,
            .adapts_steps = false};
}
}

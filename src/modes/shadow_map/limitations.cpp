#include "modes/shadow_map/limitations.h"

#include "integrate/lights/fire_lamps.h"
#include "modes/area_light_limitations.h"
#include "modes/history_limitations.h"
#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/map_shadows.h"
#include "modes/mode.h"
#include "modes/resolution.h"
#include "modes/settings.h"
#include "modes/shadow_map/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
namespace {
// Whether a light's position is in the image.
bool is_seen(const View& view, const Light& light) {
    const std::optional<vec2> at = is_distant(light) ? std::nullopt : pixel_of(view.camera, view.size, light.position);
    return at && glm::all(glm::greaterThan(*at, vec2(0))) && glm::all(glm::lessThan(*at, vec2(view.size)));
}

// Reports edges of light that fall between steps: of shafts, and of the glow around lamps in the image, including the
// lamps that stand for fire.
void add_few_steps(const View& view, const Snapshot& snapshot, const Settings& settings, Limitations& limitations) {
    constexpr int fine = 64;
    const int steps = settings.of<ShadowMapSettings>().steps;
    if (steps >= fine || snapshot.media.empty()) return;
    const auto add = [&](const LimitationKind& kind, const Light& light) {
        limitations.push_back({Severity::degraded, &kind, Subject::light, light.name, {double(steps)}});
    };
    for (const Light& light : snapshot.lights) {
        if (shadow_casters(light, snapshot)) add(limitation::grainy_edges, light);
        if (is_seen(view, light)) add(limitation::few_steps_for_glow, light);
    }
    if (!settings.terms.emission) return;
    const std::vector<Light> lamps = fire_lamps(snapshot);
    const auto seen = std::ranges::find_if(lamps, [&](const Light& lamp) { return is_seen(view, lamp); });
    if (seen != lamps.end()) add(limitation::few_steps_for_glow, *seen);
}
}

Limitations shadow_map_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    // The limitations of the march apply here too.
    Settings like = settings;
    like.fluence.orders = 1;
    like.march.visibility = Visibility::rays, like.terms.light = without_froxels(settings.terms.light);
    Limitations limitations = main_mode().limitations(view, snapshot, like);
    const ShadowMapSettings& own = settings.of<ShadowMapSettings>();
    add_map_shadows(view, snapshot, settings, limitations);
    add_steps(view, snapshot, own.steps, limitations);
    add_few_steps(view, snapshot, settings, limitations);
    std::erase_if(limitations, [](const Limitation& one) { return one.is(limitation::sampled_gobo); });
    add_sampled_filters(snapshot, Sampled::all_filters, own.steps, limitations);
    add_mean_albedo(snapshot, limitations);
    if (own.fog_resolution != Resolution::full) add_no_fog_picture(view, "shadow_map.fog_resolution", limitations);
    if (own.blur) add_no_fog_picture(view, "shadow_map.blur", limitations);
    if (view.has_history) add_moving_shadows(snapshot, limitations), add_moving_fog(snapshot, limitations);
    if (settings.terms.ambient) add_mean_environment(view, snapshot, limitations);
    add_lamps_for_faces(view, snapshot, limitations);
    if (settings.terms.emission)
        add_lamps_for_fire(snapshot, limitations), add_lamps_for_surfaces(view, snapshot, limitations);
    return limitations;
}
}

#include "modes/cone/limitations.h"

#include "modes/area_light_limitations.h"
#include "modes/cone/cone.h"
#include "modes/cone/settings.h"
#include "modes/history_limitations.h"
#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/resolution.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Whether surfaces shadow fog that is in view.
bool is_shadowed(const View& view, const Snapshot& snapshot, const Light& light) {
    constexpr int points = 16; // on each ray
    for (Ray& ray : probing_rays(view, snapshot)) {
        Hits hits;
        snapshot.occluders->closest({&ray, 1}, 0, hits);
        ray.t_max = std::min(ray.t_max, hits.t[0]);
        for (int i = 0; i < points; ++i) {
            const vec3 point = ray.at(ray.t_max * (static_cast<float>(i) + 0.5f) / points);
            const LightSample at = arrival(light, point);
            if (max_component(at.irradiance) <= 0) continue;
            if (shadow_casters(light, snapshot)->transmission({point, at.to_light, at.distance}, 0) < 1) return true;
        }
    }
    return false;
}

void add_light(const View& view, const Snapshot& snapshot, const Light& light, const ConeSettings& settings,
               Limitations& limitations) {
    const auto add = [&](Severity severity, const LimitationKind& kind) {
        limitations.push_back({severity, &kind, Subject::light, light.name});
    };
    const bool sun = is_distant(light), spot = has_cone(light);
    const bool shadows = shadow_casters(light, snapshot) != nullptr;
    if (shadows && sun && is_shadowed(view, snapshot, light))
        add(Severity::wrong, limitation::sun_without_shadows);
    else if (shadows)
        add(Severity::degraded, limitation::no_shadows);
    if (!sun && light.radius > 0) add(Severity::info, limitation::point_light_only);
    if (!sun && settings.attenuation != ConeAttenuation::inverse_square)
        add(Severity::degraded, limitation::unphysical_attenuation);
    if (spot && settings.edge == ConeEdge::soft) add(Severity::degraded, limitation::inner_cone_ignored);
    if (spot && settings.near_radius > 0) add(Severity::info, limitation::cut_near_light);
    if (!sun) add_blurred_filter(light, filter_node_angle(light), limitations);
    if (!sun && settings.noise > 0) add(Severity::info, limitation::artistic_noise);
}
}

Limitations cone_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Limitations limitations;
    for (const Light& light : snapshot.lights)
        add_light(view, snapshot, light, settings.of<ConeSettings>(), limitations);
    for (const Medium& medium : snapshot.media)
        if (medium.density.kind == DensityKind::bricks)
            limitations.push_back({only_emits(medium.optics) ? Severity::wrong : Severity::degraded,
                                   &limitation::drawn_as_homogeneous, Subject::medium, medium.name});
    add_single_scattering(view, snapshot, limitations);
    if (settings.of<ConeSettings>().resolution != Resolution::full)
        add_no_fog_picture(view, "cone.resolution", limitations);
    if (view.has_history) add_moving_fog(snapshot, limitations);
    add_mean_environment(view, snapshot, limitations);
    add_lamps_for_faces(view, snapshot, limitations);
    add_mean_albedo(snapshot, limitations), add_mean_emission(snapshot, limitations);
    if (settings.terms.emission) {
        add_emission(snapshot, true, limitations), add_lamps_for_fire(snapshot, limitations);
        add_dark_emission(snapshot, limitations), add_lamps_for_surfaces(view, snapshot, limitations);
    }
    add_to_every_mode(view, snapshot, limitations);
    return limitations;
}
}

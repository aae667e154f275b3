#include "modes/cone/limitations.h"

#include "integrate/lights/light_error.h"
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
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
void add_light(const View& view, const Snapshot& snapshot, const Light& light, const ConeSettings& settings,
               Limitations& limitations) {
    const auto add = [&](Severity severity, const LimitationKind& kind) {
        limitations.push_back({severity, &kind, Subject::light, light.name});
    };
    const bool sun = is_distant(light), spot = has_cone(light);
    constexpr double most = 100; // where none of its light is left
    if (const double off = std::min(shadow_error(view, snapshot, light), most); off > 0)
        limitations.push_back({severity_of(off), &limitation::no_shadows, Subject::light, light.name, {100 * off}});
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
    if (settings.terms.ambient) add_mean_environment(view, snapshot, limitations);
    add_lamps_for_faces(view, snapshot, limitations);
    add_mean_albedo(snapshot, limitations), add_mean_emission(snapshot, limitations);
    if (settings.terms.emission) {
        add_out_of_gamut(snapshot, limitations), add_lamps_for_fire(snapshot, limitations);
        add_lamps_for_surfaces(view, snapshot, limitations);
    }
    add_to_every_mode(view, snapshot, limitations);
    return limitations;
}
}

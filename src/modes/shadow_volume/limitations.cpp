#include "modes/shadow_volume/limitations.h"

#include "integrate/single_scattering/single_scattering.h"
#include "modes/area_light_limitations.h"
#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/settings.h"
#include "modes/shadow_volume/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/shadows/volumes/shadow_volumes.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
void add_fog(const View& view, const Snapshot& snapshot, const Settings& settings, Limitations& limitations) {
    const ShadowVolumeSettings& own = settings.of<ShadowVolumeSettings>();
    const bool sampled = settings.terms.heterogeneity && samples_fog(snapshot, own);
    if (sampled) {
        add_steps(view, snapshot, own.steps, limitations);
        if (without_froxels(settings.terms.light) == LightTransmittance::grid)
            add_light_grid_cells(snapshot, settings.terms.light_resolution, limitations);
    } else {
        for (const Medium& medium : snapshot.media)
            if (medium.density.kind == DensityKind::bricks && !only_emits(medium.optics))
                limitations.push_back(
                    {Severity::wrong, &limitation::drawn_as_homogeneous, Subject::medium, medium.name});
        add_mean_albedo(snapshot, limitations);
    }
    if (settings.terms.emission) {
        add_out_of_gamut(snapshot, limitations), add_lamps_for_fire(snapshot, limitations);
        add_lamps_for_surfaces(view, snapshot, limitations);
    }
    if (settings.terms.ambient) add_mean_environment(view, snapshot, limitations);
    add_single_scattering(view, snapshot, limitations);
    add_lamps_for_faces(view, snapshot, limitations);
}

void add_shadows(const Snapshot& snapshot, Limitations& limitations) {
    constexpr size_t many_edges = 20000;
    for (const Light& light : snapshot.lights) {
        if (!shadow_casters(light, snapshot)) continue;
        if (is_soft(light))
            limitations.push_back({Severity::degraded, &limitation::hard_shadows, Subject::light, light.name});
        const size_t edges = cached_shadow_volumes(snapshot, light)->sides.size();
        if (edges > many_edges)
            limitations.push_back({Severity::info,
                                   &limitation::many_silhouette_edges,
                                   Subject::light,
                                   light.name,
                                   {static_cast<double>(edges)}});
    }
    if (has_alpha_shadows(snapshot))
        limitations.push_back({Severity::wrong, &limitation::no_alpha_shadows, Subject::surfaces});
}
}

Limitations shadow_volume_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    Limitations limitations;
    if (settings.of<ShadowVolumeSettings>().draw == ShadowDraw::shells)
        limitations.push_back({Severity::wrong, &limitation::shells, Subject::setting, "shadow_volume.draw"});
    add_fog(view, snapshot, settings, limitations);
    add_light_transmittance(snapshot, settings.terms.light, limitations);
    add_sampled_filters(snapshot, Sampled::fine_gobos, gobo_nodes, limitations);
    add_shadows(snapshot, limitations);
    add_fog_through_middle(view, snapshot, limitations);
    add_to_every_mode(view, snapshot, limitations);
    return limitations;
}
}

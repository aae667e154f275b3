#include "modes/march/limitations.h"

#include "integrate/single_scattering/single_scattering.h"
#include "modes/area_light_limitations.h"
#include "modes/light_filters.h"
#include "modes/map_shadows.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Reports lights whose shadows the visibility setting ignores, or finds by another method than it names.
void add_visibility(const View& view, const Snapshot& snapshot, const Settings& settings, Limitations& limitations) {
    const Visibility visibility = settings.march.visibility;
    const bool alpha = has_alpha_shadows(snapshot);
    if (visibility == Visibility::off)
        for (const Light& light : snapshot.lights)
            if (light.shadows)
                limitations.push_back({Severity::wrong, &limitation::visibility_off, Subject::light, light.name});
    if (alpha && (visibility == Visibility::intervals || visibility == Visibility::exact))
        limitations.push_back(
            {Severity::info, &limitation::sampled_alpha_shadows, Subject::setting, "march.visibility"});
    const bool exact = visibility == Visibility::intervals && !alpha;
    const bool room = exact && has_room_for_volumes(view, snapshot);
    if (exact)
        for (const Light& light : snapshot.lights)
            if (const auto& casters = shadow_casters(light, snapshot);
                casters && exact_shadows(view, light, *casters, room) == ShadowMethod::rays)
                limitations.push_back({Severity::info,
                                       &limitation::sampled_shadows,
                                       Subject::light,
                                       light.name,
                                       {static_cast<double>(casters->triangle_count())}});
    if (visibility == Visibility::maps) add_map_shadows(view, snapshot, settings, limitations);
}
}

Limitations march_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    const TermSettings& terms = settings.terms;
    Limitations limitations;
    if (settings.fluence.orders < 2)
        add_single_scattering(view, snapshot, limitations);
    else
        add_fluence(view, snapshot, settings, limitations);
    const bool no_froxels = terms.light == LightTransmittance::froxel && view.camera.lens;
    if (terms.light == LightTransmittance::grid || no_froxels)
        add_light_grid_cells(snapshot, terms.light_resolution, limitations);
    for (const Medium& medium : snapshot.media)
        if (!terms.heterogeneity && medium.density.kind == DensityKind::bricks)
            limitations.push_back({Severity::wrong, &limitation::drawn_as_homogeneous, Subject::medium, medium.name});
    if (!terms.heterogeneity) add_mean_emission(snapshot, limitations), add_mean_albedo(snapshot, limitations);
    add_visibility(view, snapshot, settings, limitations);
    add_light_transmittance(snapshot, terms.light, limitations);
    add_sampled_filters(snapshot, Sampled::fine_gobos, gobo_nodes, limitations);
    if (terms.emission) add_out_of_gamut(snapshot, limitations);
    add_to_every_mode(view, snapshot, limitations);
    return limitations;
}
}

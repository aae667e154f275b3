#include "integrate/single_scattering/single_scattering.h"

#include "scene/lights/light_filter.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
namespace {
// Triangle counts above which shadow rays are used instead. Slices, for soft lights, are recomputed for every ray:
// among scattered balls of 200 000 triangles they take seven times as long as 28 shadow rays. Volumes, for other
// lights, are built once for rays from one point, so cameras with a lens use slices.
constexpr uint64_t max_sliced = 200'000, max_with_volumes = 2'000'000;
}

bool has_room_for_volumes(const View& view, const Snapshot& snapshot) {
    return has_room_for_views(snapshot, [&](const Light& light) { return is_soft(light) || view.camera.lens ? 0 : 1; });
}

ShadowMethod exact_shadows(const View& view, const Light& light, const Occluders& occluders, bool room) {
    const bool sliced = is_soft(light) || view.camera.lens || !room;
    const uint64_t most = sliced ? max_sliced : max_with_volumes;
    if (occluders.has_alpha() || occluders.triangle_count() > most) return ShadowMethod::rays;
    return sliced ? ShadowMethod::slices : ShadowMethod::volumes;
}

FilterSteps filter_steps(const Light& light) {
    if (!light.filter) return {};
    const double detail = finest_detail(*light.filter), sets = gobo_nodes / 4;
    if (!light.filter->gobo) return {4 * detail, sets, false};
    return cone_angle(light) <= sets * detail ? FilterSteps{detail, sets, false} : FilterSteps{1e-9, gobo_nodes, true};
}

bool has_grid(const Snapshot& snapshot) {
    return std::ranges::any_of(snapshot.media, [](const Medium& m) { return m.density.kind == DensityKind::bricks; });
}

void add_lights(const View& view, LightTransmittance method, int light_resolution,
                const std::function<ShadowMethod(const Light&)>& by, SingleScattering& frame) {
    frame.camera = view.camera;
    frame.lobe = lobe_cuts(frame.snapshot.media);
    frame.margin = view.filter == PixelFilter::center ? 0 : std::max(view.filter_radius - 0.5f, 0.0f);
    for (const Light& light : frame.snapshot.lights) {
        frame.depths.push_back(make_light_depth(frame.snapshot, light, method, light_resolution, &view));
        frame.depths.back().scale = frame.style.light_depth;
        frame.cones.push_back(cone_falloff(light));
        frame.filter_steps.push_back(filter_steps(light));
        LightShadows& shadows = frame.shadows.emplace_back();
        const auto& casters = shadow_casters(light, frame.snapshot);
        if (!casters) continue;
        shadows.by = by(light);
        if (shadows.by == ShadowMethod::slices) shadows.slices = &casters->shadow_slices();
        if (shadows.by != ShadowMethod::volumes) continue;
        shadows.volumes = cached_shadow_volumes(frame.snapshot, light);
        shadows.view = cached_shadow_view(frame.snapshot, light, view, frame.margin);
    }
}
}

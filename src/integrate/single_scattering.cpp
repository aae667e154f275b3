#include "integrate/single_scattering.h"

#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <algorithm>

namespace tyndall {
bool has_grid(const Snapshot& snapshot) {
    return std::ranges::any_of(snapshot.media, [](const Medium& m) { return m.kind == DensityKind::bricks; });
}

void add_lights(const View& view, LightTransmittance method, int light_resolution,
                const std::function<ShadowsBy(const Light&)>& by, SingleScattering& frame) {
    frame.camera = view.camera;
    frame.margin = view.filter == PixelFilter::center ? 0 : std::max(view.filter_radius - 0.5f, 0.0f);
    for (const Light& light : frame.snapshot.lights) {
        frame.depths.push_back(make_light_depth(frame.snapshot, light, method, light_resolution, &view));
        frame.depths.back().scale = frame.style.light_depth;
        frame.cones.push_back(cone_falloff(light));
        LightShadows& shadows = frame.shadows.emplace_back();
        if (!casts(light, frame.snapshot)) continue;
        shadows.by = by(light);
        if (shadows.by == ShadowsBy::slices) frame.slices = frame.snapshot.occluders->shadow_slices();
        if (shadows.by != ShadowsBy::volumes) continue;
        shadows.volumes = cached_shadow_volumes(frame.snapshot, light);
        shadows.view = cached_shadow_view(frame.snapshot, light, view, frame.margin);
    }
}
}

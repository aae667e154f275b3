#include "modes/radial_blur/limitations.h"

#include "modes/area_light_limitations.h"
#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/radial_blur/radial_blur.h"
#include "modes/radial_blur/settings.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Position of a light in the image at one of the shutter's time samples.
std::optional<vec2> place_of(const std::string& light, const View& view, const Snapshot& moment, const Camera& camera) {
    const auto found = std::ranges::find(moment.lights, light, &Light::name);
    if (found == moment.lights.end()) return {};
    const float far = 1e4f * moment.extent;
    return pixel_of(camera, view.size, is_distant(*found) ? camera.position - far * found->direction : found->position);
}

void add_middle(const View& view, const Snapshot& snapshot, const std::string& light, Limitations& limitations) {
    if (!view.shutter || !snapshot.moments) return;
    const auto first = place_of(light, view, snapshot.moments->front(), view.shutter->cameras.front());
    const auto last = place_of(light, view, snapshot.moments->back(), view.shutter->cameras.back());
    const double moved = first && last ? double(glm::distance(*first, *last)) : 0;
    if (moved > 1)
        limitations.push_back({Severity::degraded, &limitation::rays_of_the_middle, Subject::light, light, {moved}});
}
}

Limitations radial_blur_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    const RadialBlurSettings& own = settings.of<RadialBlurSettings>();
    Limitations limitations{{Severity::degraded, &limitation::screen_space, Subject::image}};
    for (const Medium& medium : snapshot.media)
        if (medium.density.kind == DensityKind::bricks && own.fog)
            limitations.push_back({Severity::degraded, &limitation::homogeneous_dimming, Subject::medium, medium.name});
    add_mean_filters(snapshot, limitations);
    add_fog_through_middle(view, snapshot, limitations);
    add_left_out_light(snapshot, settings.terms.emission, limitations);
    add_lamps_for_faces(view, snapshot, limitations);
    const std::vector<BlurLight> seen = blur_lights(view, snapshot, own);
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const auto found = std::ranges::find(seen, i, &BlurLight::index);
        const std::string& name = snapshot.lights[i].name;
        if (found != seen.end()) add_middle(view, snapshot, name, limitations);
        if (found == seen.end())
            limitations.push_back({Severity::wrong, &limitation::light_off_screen, Subject::light, name});
        else if (found->fade < 1)
            limitations.push_back({Severity::degraded, &limitation::light_leaving_screen, Subject::light, name});
    }
    add_to_every_mode(view, snapshot, limitations);
    return limitations;
}
}

#include "modes/radial_blur/limitations.h"

#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/radial_blur/radial_blur.h"
#include "modes/radial_blur/settings.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
Limitations radial_blur_limitations(const View& view, const Snapshot& snapshot, const Settings& settings) {
    const RadialBlurSettings& own = settings.of<RadialBlurSettings>();
    Limitations limitations{{Severity::degraded, &limitation::screen_space, Subject::image}};
    for (const Medium& medium : snapshot.media)
        if (medium.density.kind == DensityKind::bricks && own.fog)
            limitations.push_back({Severity::degraded, &limitation::homogeneous_dimming, Subject::medium, medium.name});
    add_mean_filters(snapshot, limitations);
    add_fog_through_middle(view, snapshot, limitations);
    add_left_out_emission(snapshot, limitations);
    add_left_out_environment(snapshot, limitations);
    add_lamps_for_faces(snapshot, limitations);
    const std::vector<BlurLight> seen = blur_lights(view, snapshot, own);
    for (size_t i = 0; i < snapshot.lights.size(); ++i) {
        const auto found = std::ranges::find(seen, i, &BlurLight::index);
        const std::string& name = snapshot.lights[i].name;
        if (found == seen.end())
            limitations.push_back({Severity::wrong, &limitation::light_off_screen, Subject::light, name});
        else if (found->fade < 1)
            limitations.push_back({Severity::degraded, &limitation::light_leaving_screen, Subject::light, name});
    }
    return limitations;
}
}

#include "modes/light_filters.h"

#include "integrate/single_scattering/single_scattering.h"
#include "scene/light.h"
#include "scene/lights/light_filter.h"
#include "trace/snapshot.h"

namespace tyndall {
void average_filters(Snapshot& snapshot) {
    for (Light& light : snapshot.lights)
        if (light.filter) light.intensity *= mean_factor(light).mean, light.filter = nullptr;
}

void add_mean_filters(const Snapshot& snapshot, Limitations& limitations) {
    for (const Light& light : snapshot.lights)
        if (light.filter)
            limitations.push_back(
                {Severity::wrong, &limitation::mean_filter, Subject::light, light.name, {mean_factor(light).spread}});
}

void add_sampled_filters(const Snapshot& snapshot, Sampled which, double nodes, Limitations& limitations) {
    for (const Light& light : snapshot.lights) {
        if (!light.filter || light.area || (which == Sampled::fine_gobos && !filter_steps(light).sampled)) continue;
        const double texels = cone_angle(light) / nodes / finest_detail(*light.filter);
        limitations.push_back({Severity::info, &limitation::sampled_gobo, Subject::light, light.name, {texels}});
    }
}

void add_blurred_filter(const Light& light, float angle, Limitations& limitations) {
    const bool smooth = light.area != nullptr; // its filter is the cosine emission of a face
    if (!light.filter || smooth || finest_detail(*light.filter) >= angle) return;
    limitations.push_back(
        {Severity::degraded, &limitation::blurred_filter, Subject::light, light.name, {glm::degrees(double{angle})}});
}
}

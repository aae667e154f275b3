#include "modes/limits.h"

#include <cstdio>

namespace tyndall {
namespace {
// How thick a medium can be at most across its own bounds, as optical depth.
float thickness(const Medium& medium, const Box& scene_bounds) {
    Box box = medium.world_bounds;
    box.low = glm::max(box.low, scene_bounds.low), box.high = glm::min(box.high, scene_bounds.high);
    return box.empty() ? 0 : medium.majorant() * glm::length(box.size());
}
}

void add_single_scattering_limits(const Snapshot& snapshot, std::vector<Limit>& limits) {
    for (const Medium& medium : snapshot.media) {
        const float scattered = thickness(medium, snapshot.bounds) * max_component(medium.optics.albedo);
        if (scattered <= 0.5f) continue;
        char depths[32];
        std::snprintf(depths, sizeof depths, "%.2g", scattered);
        limits.push_back({scattered > 2 ? Severity::degraded : Severity::info, "medium " + medium.name,
                          "light scatters once only; up to " + std::string(depths) +
                              " optical depths of scattering make real fog this thick brighter and softer"});
    }
    if (max_component(snapshot.ambient) > 0)
        limits.push_back({Severity::info, "ambient", "ambient light is not shadowed by surfaces or fog"});
}
}

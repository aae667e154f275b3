#include "modes/limits.h"

#include "trace/light_paths.h"

#include <algorithm>
#include <cstdio>

namespace tyndall {
namespace {
// How thick a medium can be at most across its own bounds, as optical depth.
float thickness(const Medium& medium, const Box& scene_bounds) {
    Box box = medium.world_bounds;
    box.low = glm::max(box.low, scene_bounds.low), box.high = glm::min(box.high, scene_bounds.high);
    return box.empty() ? 0 : medium.majorant() * glm::length(box.size());
}

void add_ambient_limit(const Snapshot& snapshot, std::vector<Limit>& limits) {
    if (max_component(snapshot.ambient) > 0)
        limits.push_back({Severity::info, "ambient", "ambient light is not shadowed by surfaces or fog"});
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
    add_ambient_limit(snapshot, limits);
}

void add_fluence_limits(const Snapshot& snapshot, const FluenceSettings& settings, std::vector<Limit>& limits) {
    add_ambient_limit(snapshot, limits);
    const auto is_endless = [](const Medium& medium) { return !is_finite(medium.world_bounds.size()); };
    const Box fog = fog_bounds(snapshot, light_reach(snapshot));
    if (snapshot.lights.empty() || fog.empty()) return;
    char cell[32];
    std::snprintf(cell, sizeof cell, "%.2g m",
                  static_cast<double>(max_component(fog.size()) / static_cast<float>(settings.resolution)));
    limits.push_back({Severity::info, "fluence.resolution",
                      "light that has been scattered before comes from cells of " + std::string(cell) +
                          ": its detail is no finer, and it leaks through walls thinner than that"});
    limits.push_back({Severity::info, "fluence.orders",
                      "fog lights no surfaces, and surfaces light fog but not each other; ambient light and what glows "
                      "are not scattered again"});
    if (std::ranges::any_of(snapshot.media, is_endless))
        limits.push_back({Severity::info, "fluence.orders",
                          "of endless fog only what lies in and around the scene scatters light again"});
    if (settings.orders < all_orders)
        limits.push_back({Severity::info, "fluence.orders",
                          "light that scatters more than " + std::to_string(settings.orders) + " times is left out"});
}
}

#include "modes/froxel/glow.h"

#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall {
float glow_angle(const Phase& phase) { return 0.77f * (1 - narrowest_g(phase)); }

float tile_angle(const View& view, int tile) {
    if (view.camera.ortho_height > 0) return 0;
    return view_height(view.camera) / static_cast<float>(view.size.y) * static_cast<float>(tile);
}

bool shows_sun(const View& view, const Snapshot& snapshot, const Light& light) {
    if (!is_distant(light) || view.camera.ortho_height > 0) return false;
    const vec3 at = view.camera.position - 1e5f * snapshot.extent * light.direction;
    const std::optional<vec2> pixel = pixel_of(view.camera, view.size, at);
    return pixel && glm::all(glm::greaterThan(*pixel, vec2(0))) && glm::all(glm::lessThan(*pixel, vec2(view.size)));
}

std::vector<Medium> media_in_sunlight(const View& view, const Snapshot& snapshot, int tile) {
    constexpr float widest = 0.15f; // radians; larger froxels do not resolve a glow at all
    const float across = std::min(tile_angle(view, tile), widest);
    const auto narrow = [&](const Medium& medium) {
        return medium.optics.phase.shape && is_narrow(medium.optics.phase, across);
    };
    const bool suns = std::ranges::any_of(snapshot.lights, [](const Light& light) { return is_distant(light); });
    if (!suns || tile == 1 || std::ranges::none_of(snapshot.media, narrow)) return {};
    std::vector<Medium> media = snapshot.media;
    // Convolved twice with disks of a froxel's area: smooth enough that the sum over froxels hardly depends on their
    // alignment.
    const double radius = across / std::sqrt(pi);
    for (Medium& medium : media)
        if (narrow(medium)) medium.optics.phase = widened(widened(medium.optics.phase, radius), radius);
    return media;
}
}

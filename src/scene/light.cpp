// What of a light reaches a point, by KHR_lights_punctual.
#include "scene/light.h"

namespace tyndall {
Arrival arrival(const Light& light, vec3 point) {
    if (light.kind == LightKind::sun) return {light.intensity, -light.direction, infinity};

    // Inverse square law, held inside the glowing ball (or a tenth of a millimetre) so that it stays finite.
    const vec3 towards = light.position - point;
    const float distance = glm::length(towards), reach = std::max(light.radius, smallest_radius);
    const vec3 to_light = distance > 0 ? towards / distance : -light.direction;
    float share = range_window(distance, light.range) / std::max(distance * distance, reach * reach);
    if (light.kind == LightKind::spot) share *= cone_falloff(light).at(-glm::dot(to_light, light.direction));
    return {light.intensity * share, to_light, distance};
}
}

// A light at one moment, as KHR_lights_punctual with soft edges, and what of it reaches a point.
#pragma once
#include "base/math.h"

#include <string>

namespace tyndall {
enum class LightKind { point, spot, sun };

struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    vec3 position{0};              // point, spot
    vec3 direction{0, -1, 0};      // unit, the way the light travels: spot axis, sun
    vec3 intensity{1};             // candela (point, spot) or lux (sun), colour included
    float volume_scale = 1;        // multiplies the light in fog
    float surface_scale = 1;       // multiplies the light on surfaces
    float inner_cone = 0, outer_cone = pi / 4;   // half angles of a spot
    float range = infinity;        // metres; the light fades to 0 there
    float radius = 0;              // metres; point, spot: soft shadows, and 1/r² is capped inside
    float angle = 0;               // radians, half angle of the sun's disc
    bool shadows = true;
};

// What reaches a point with nothing in the way: irradiance on a surface facing the light (or lux for fog).
struct Arrival {
    vec3 irradiance{0};
    vec3 to_light{0, 1, 0};      // unit
    float distance = infinity;   // metres, infinite for the sun
};
Arrival arrival(const Light& light, vec3 point);

// KHR_lights_punctual's window: 1 near the light, 0 at range.
inline float range_window(float distance, float range) {
    if (std::isinf(range)) return 1;
    const float x = distance / range, x4 = x * x * x * x;
    return std::clamp(1 - x4, 0.0f, 1.0f);
}
}

// Suns: parallel light; with an angle, a disc in the sky.
#include "scene/lights/functions.h"

namespace tyndall {
namespace {
LightSample sun_arrival(const Light& light, const vec3&) { return {light.intensity, -light.direction, infinity}; }

Ray sun_sample(const Light& light, vec3 point, vec2 u) {
    const float half = std::sin(0.5f * light.angle);
    return {point, light.angle > 0 ? direction_in_cone(-light.direction, 2 * half * half, u) : -light.direction};
}

bool sun_is_soft(const Light& light) { return light.angle > 0; }

Box sun_bounds(const Light&) { return {}; }

Interval<double> sun_reach(const Light&, dvec3, dvec3) { return {-infinity, infinity}; }
}

const LightFunctions sun_functions{sun_arrival, sun_sample, sun_is_soft, sun_bounds, sun_reach};
}

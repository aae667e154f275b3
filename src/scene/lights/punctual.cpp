// Point lights and spots as in KHR_lights_punctual; spherical lights if they have a radius.
#include "scene/lights/functions.h"
#include "scene/lights/light_filter.h"
#include "scene/lights/light_reach.h"

namespace tyndall {
namespace {
// Inverse square law, capped inside the light's sphere (or its core) so that it stays finite.
LightSample punctual_arrival(const Light& light, const vec3& point) {
    const vec3 towards = light.position - point;
    const float distance = glm::length(towards), reach = capped_radius(light);
    const vec3 to_light = distance > 0 ? towards / distance : -light.direction;
    float share = range_window(distance, light.range) / std::max(distance * distance, reach * reach);
    if (has_cone(light)) share *= cone_falloff(light).at(-glm::dot(to_light, light.direction));
    vec3 irradiance = light.intensity * share;
    if (light.filter && share > 0) irradiance *= vec3(filtered(*light.filter, -dvec3(to_light)));
    return {irradiance, to_light, distance};
}

float one_minus_cosine(float sine_squared) { return sine_squared / (1 + std::sqrt(std::max(0.0f, 1 - sine_squared))); }

Ray punctual_sample(const Light& light, vec3 point, vec2 u) {
    const vec3 towards = light.position - point;
    const float distance = glm::length(towards);
    if (!(distance > light.radius)) return {point, -light.direction, 0};
    const vec3 axis = towards / distance;
    if (!(light.radius > 0)) return {point, axis, distance * shadow_reach<float>};

    // The intersection with the sphere: the nearer of the two roots of |t·d - towards|² = r².
    const float sine = light.radius / distance;
    const vec3 direction = direction_in_cone(axis, one_minus_cosine(sine * sine), u);
    const float along = glm::dot(direction, towards);
    const vec3 off = towards - along * direction;
    const float half_chord = std::sqrt(std::max(0.0f, light.radius * light.radius - glm::dot(off, off)));
    return {point, direction, (along - half_chord) * shadow_reach<float>};
}

bool punctual_is_soft(const Light& light) { return light.radius > 0; }

Box punctual_bounds(const Light& light) { return {light.position, light.position}; }

// The sphere of the range and the cone of a spot.
Interval<double> punctual_reach(const Light& light, dvec3 origin, dvec3 direction) {
    Interval<double> reach{-infinity, infinity};
    if (!std::isinf(light.range)) reach = inside_ball(light.position, light.range, origin, direction);
    if (!has_cone(light) || reach.empty()) return reach;
    const dvec3 axis = glm::normalize(dvec3(light.direction));
    return intersection(reach, inside_cone(light.position, axis, light.outer_cone, origin, direction));
}
}

const LightFunctions punctual_functions{punctual_arrival, punctual_sample, punctual_is_soft, punctual_bounds,
                                        punctual_reach};
}

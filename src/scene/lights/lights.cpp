// Dispatches calls on a light to the functions of its kind.
#include "scene/lights/functions.h"
#include "scene/lights/light_reach.h"

namespace tyndall {
namespace {
const LightFunctions& functions_of(const Light& light) {
    static const LightFunctions* const table[] = {&punctual_functions, &punctual_functions, &sun_functions,
                                                  &punctual_functions, &punctual_functions, &punctual_functions};
    static_assert(std::size(table) == std::size(light_kinds));
    return *table[static_cast<int>(light.kind)];
}
}

LightSample arrival(const Light& light, const vec3& point) { return functions_of(light).arrival(light, point); }

Ray ray_to_light(const Light& light, vec3 point, vec2 u) { return functions_of(light).sample(light, point, u); }

bool is_soft(const Light& light) { return functions_of(light).is_soft(light); }

Box light_bounds(const Light& light) { return functions_of(light).bounds(light); }

Interval<double> light_reach(const Light& light, dvec3 origin, dvec3 direction) {
    return functions_of(light).reach(light, origin, direction);
}

vec3 direction_in_cone(vec3 axis, float one_minus_cosine, vec2 u) {
    const float height = u.x * one_minus_cosine; // 1 - cosine of the direction
    const float across = std::sqrt(std::max(0.0f, height * (2 - height))), turn = 2 * pi * u.y;
    vec3 x, y;
    make_frame(axis, x, y);
    return glm::normalize((1 - height) * axis + across * std::cos(turn) * x + across * std::sin(turn) * y);
}
}

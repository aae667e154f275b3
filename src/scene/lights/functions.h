// The functions of a kind of light: a row in the table of lights.cpp.
#pragma once
#include "scene/light.h"

namespace tyndall {
struct LightFunctions {
    LightSample (*arrival)(const Light& light, const vec3& point);
    Ray (*sample)(const Light& light, vec3 point, vec2 u); // as ray_to_light()
    bool (*is_soft)(const Light& light);
    Box (*bounds)(const Light& light); // as light_bounds()
    Interval<double> (*reach)(const Light& light, dvec3 origin, dvec3 direction);
};

extern const LightFunctions punctual_functions; // point lights and spots
extern const LightFunctions sun_functions;

// A direction within a cone about `axis`, uniform over solid angle; one_minus_cosine is that of the cone's half angle.
vec3 direction_in_cone(vec3 axis, float one_minus_cosine, vec2 u);
}

// Rays from a point to a light.
#pragma once
#include "scene/light.h"

namespace tyndall {
// The ray to a point on the light, picked by two numbers in [0,1): uniform over the solid angle that the light's ball
// or disc is seen under; its centre when the light is a point. Ends just before the light.
Ray ray_to_light(const Light& light, vec3 point, vec2 u);
}

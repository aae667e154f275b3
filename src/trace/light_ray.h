// Rays from a point to a light.
#pragma once
#include "base/math.h"

namespace tyndall {
struct Light;

// The ray to a point on the light, picked by two numbers in [0,1): uniform over the solid angle that the light's ball
// or disc is seen under; its centre when the light is a point. Ends just before the light.
Ray ray_to_light(const Light& light, vec3 point, vec2 u);

// One point of a light for a whole camera ray.
struct LightPoint {
    dvec3 at{0};      // its place; of a sun the direction towards it, unit
    bool far = false; // a sun
    dvec3 center{0};  // of the light's ball
    double radius = 0;
};

// The centre of the light.
LightPoint center_of(const Light& light);

// A random point of a soft light. Of a sun the direction ray_to_light() takes. Of a ball a point with density
// 1/√(radius² - r²), the one that from every side is seen as an evenly filled disc: uniform over solid angle but for
// O(radius²/distance²); u.xy are well spread as seen from where the ray passes it.
LightPoint point_on(const Light& light, const Ray& ray, vec3 u);
}

// The point of a light that a whole camera ray sees.
#pragma once
#include "scene/light.h"

namespace tyndall {
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

// Points on lights for camera rays.
#pragma once
#include "scene/light.h"

namespace tyndall {
// One point of a light, used for a whole camera ray.
struct LightPoint {
    dvec3 at{0};      // its position; for a sun, the unit direction toward it
    bool far = false; // a sun
    dvec3 center{0};  // of the light's sphere
    double radius = 0;
};

// The center of the light.
LightPoint center_of(const Light& light);

// The shadow ray to the light's point; ends just before it, or before the surface of the light's sphere.
Ray ray_to_point(const LightPoint& to, dvec3 from);

// A random point of a soft light. For a sun, the direction that ray_to_light() picks. For a sphere, a point with
// density 1/√(radius² - r²), whose projection from every side is a uniform disc: uniform over solid angle up to
// O(radius²/distance²). u.xy stay well distributed as seen from the point where the ray passes the light.
LightPoint point_on(const Light& light, const Ray& ray, vec3 u);
}

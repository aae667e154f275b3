// The intervals of lines and rays that a light can reach.
#pragma once
#include "base/math.h"

namespace tyndall {
struct Light;

// The interval of t in which origin + t·direction (direction of any length) lies inside the cone with half_angle
// (0..π/2) around `axis` (unit) from `apex`. Its ends may be infinite.
Interval<double> inside_cone(dvec3 apex, dvec3 axis, double half_angle, dvec3 origin, dvec3 direction);

// The interval of a line inside a sphere whose center it passes at t = nearest, `distance` meters away; `length` is
// that of the line's direction.
Interval<double> chord(double nearest, double distance, double radius, double length);

// The interval of a line inside a sphere.
Interval<double> inside_ball(dvec3 center, double radius, dvec3 origin, dvec3 direction);

// The interval in which unoccluded light arrives: inside the sphere of the light's range and a spot's cone; infinite if
// neither bounds it.
Interval<double> light_reach(const Light& light, dvec3 origin, dvec3 direction);

// The same, clipped to an interval of a ray.
Interval<float> light_reach(const Light& light, const Ray& ray, Interval<float> stretch);
}

// What a light reaches of a line.
#pragma once
#include "base/math.h"

namespace tyndall {
struct Light;

// The stretch of origin + t·direction, direction of any length, whose points lie within half_angle (0..π/2) of the axis
// (unit) as seen from the apex. Its ends may be infinite.
Interval<double> inside_cone(dvec3 apex, dvec3 axis, double half_angle, dvec3 origin, dvec3 direction);

// The stretch of a line inside a ball whose centre it passes at t = nearest, at `distance` metres; `length`: of the
// line's direction.
Interval<double> chord(double nearest, double distance, double radius, double length);

// The stretch inside a ball.
Interval<double> inside_ball(dvec3 center, double radius, dvec3 origin, dvec3 direction);

// Where its light arrives with nothing in the way: inside the ball of its range and the cone of a spot; endless where
// nothing bounds it.
Interval<double> light_reach(const Light& light, dvec3 origin, dvec3 direction);

// What of a stretch of a ray that is.
Interval<float> light_reach(const Light& light, const Ray& ray, Interval<float> stretch);
}

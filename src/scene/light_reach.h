// Where a line is inside the cone of a spot.
#pragma once
#include "base/math.h"

namespace tyndall {
// The stretch of origin + t·direction, direction of any length, whose points lie within half_angle (0..π/2) of the axis
// (unit) as seen from the apex. Its ends may be infinite.
Interval<double> inside_cone(dvec3 apex, dvec3 axis, double half_angle, dvec3 origin, dvec3 direction);
}

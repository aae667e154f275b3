// Data for drawings of a ray, independent of the drawing library.
#pragma once
#include "measure/explain/explain.h"
#include "volume/bricks/brick_walk.h"

namespace tyndall::ray_drawing {
// The range of the distance axis: it ends where hardly any light gets to the eye, and starts near the fog if that is
// far away.
Interval<double> axis_of(const RayReport& report);

// How a light shines on each step.
std::vector<LightState> light_states(const RayReport& report, const LightOnRay& light);

// The `most` brightest lights, in the report's order.
std::vector<size_t> brightest_lights(const RayReport& report, size_t most);

// Luminance per meter that arrives at the eye from a source at a step.
double eye_luminance(const RayStep& step, vec3 source);

// The end of an axis for such values: set by what hardly any of the ray exceeds, since next to a lamp values are
// unbounded. `most` returns the largest.
double light_scale(const RayReport& report, double& most);
}

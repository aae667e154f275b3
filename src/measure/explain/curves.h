// What drawings of a ray show, whatever they are drawn with.
#pragma once
#include "measure/explain/explain.h"
#include "volume/bricks/brick_walk.h"

namespace tyndall::ray_drawing {
// The axis of distances: it goes on until hardly anything is seen, and begins with the fog where that is far away.
Interval<double> axis_of(const RayStory& story);

// What a light does at each step.
std::vector<Lighting> states_of(const RayStory& story, const LightOnRay& light);

// The brightest lights, in the story's order.
std::vector<size_t> drawn_lights(const RayStory& story, size_t most);

// Luminance per metre that arrives at the eye, of a source at a step.
double arriving(const RayStep& step, vec3 source);

// Where the axis of such values ends: values that hardly any of the ray exceeds decide, as next to a lamp they have no
// end. `most` is the largest.
double light_scale(const RayStory& story, double& most);
}

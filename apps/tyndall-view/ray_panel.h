// What happens on the ray of a pixel.
#pragma once
#include "panels.h"
#include "viewer/painting/ray_question.h"

namespace tyndall {
// In the space that is left of the current window: curves on the left, the techniques' answers on the right.
void draw_ray(const ViewState& state, const RayAnswer* answer, const Act& act);
}

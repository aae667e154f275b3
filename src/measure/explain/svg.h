// What the drawing of a ray is made of. Internal to it.
#pragma once
#include "measure/explain/report.h"
#include "measure/report/svg.h"

namespace tyndall {
namespace ray_drawing {
inline constexpr double width = 1000, left = 120, right = 980; // of the drawing, and of its panels
inline constexpr const char* ink = "#222";
}

// Bars for the modes from `top` on; returns where they end.
double draw_modes(const RayStory& story, double top, Svg& svg);
}

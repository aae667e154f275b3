// The parts of a ray's drawing. Internal to it.
#pragma once
#include "measure/explain/report.h"
#include "measure/report/svg.h"

namespace tyndall {
namespace ray_drawing {
inline constexpr double width = 1000, left = 120, right = 980; // of the drawing, and of its panels
inline constexpr const char* ink = "#222";
}

// Draws bars for the modes from `top` down; returns their lower end.
double draw_modes(const RayReport& report, double top, Svg& svg);
}

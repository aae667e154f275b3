// Surfaces behind the fog: Lambert, lit through the fog, shadowed, plus emission and ambient light.
#pragma once
#include "trace/light_depth.h"

#include <span>
#include <vector>

namespace tyndall {
// Radiance leaving each point towards the viewer. Up to 16 points; `u` (two numbers in [0,1) per point) picks the point
// on soft lights. per_light (optional) receives points × lights radiances.
void shade_surfaces(const Snapshot& snapshot, std::span<const LightDepth> depths, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light = nullptr);
}

// Surfaces behind the fog: Lambert, lit through the fog, shadowed, plus emission and ambient light.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct LightDepth;
struct Snapshot;
struct SurfacePoint;

// Radiance leaving each point towards the viewer. Up to 16 points; `u`, points × n pairs of numbers in [0,1), picks n
// points on each soft light, and n directions of the environment: n for the first point, then n for the next. per_light
// (optional) receives points × lights radiances.
void shade_surfaces(const Snapshot& snapshot, std::span<const LightDepth> depths, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light = nullptr);

// A direction picked by the cosine to a normal, from two numbers in [0,1); the square of the sine is the first.
vec3 cosine_direction(vec3 normal, vec2 u);
}

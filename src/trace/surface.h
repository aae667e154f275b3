// Shading of Lambertian surfaces: light attenuated by fog and shadowed, plus emission and ambient light.
#pragma once
#include "base/math.h"

#include <span>
#include <vector>

namespace tyndall {
struct LightDepth;
struct Snapshot;
struct SurfacePoint;

// Radiance leaving each of up to 16 points toward the viewer. `depths`: one per light; a light without one is not
// attenuated by fog. `u`: points × n sample pairs in [0,1), n for the first point, then n for the next; they choose n
// points on each soft light, and n directions of the environment. per_light (optional) receives points × lights
// radiances.
void shade_surfaces(const Snapshot& snapshot, std::span<const LightDepth> depths, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> radiance, std::vector<vec3>* per_light = nullptr);

// A cosine-distributed direction about a normal, from two numbers in [0,1); u.x is the squared sine.
vec3 cosine_direction(vec3 normal, vec2 u);
}

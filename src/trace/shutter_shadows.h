// Shadow rays whose motion tells how fast shadows move through fog: a lamp that moves little moves far shadows far.
#pragma once
#include "base/math.h"

#include <cstdint>
#include <vector>

namespace tyndall {
struct Scene;

// From a light through a point between two vertices of a mesh.
struct ShadowRay {
    size_t light = 0, instance = 0;
    size_t from = 0, to = 0; // vertices
    float share = 0;         // of the way between them
    float distance = 0;      // from a local light to that point, in the middle of the exposure
};

// Rays of the lights and meshes that move, spread evenly over them; a bounded number.
std::vector<ShadowRay> shadow_rays(const Scene& scene, double seconds, float extent);

// Adds points along each ray, from the mesh to as far as the light reaches or the scene extends; the same number at all
// times, not finite where the light does not shine.
void add_shadows(const Scene& scene, const std::vector<ShadowRay>& rays, double seconds, float extent,
                 std::vector<vec3>& points);
}

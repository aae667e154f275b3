// Surfaces that give off light, as targets: points on them are picked by area times brightness.
#pragma once
#include "base/math.h"

#include <memory>
#include <vector>

namespace tyndall {
class Occluders;
struct Snapshot;

struct EmissiveTriangle {
    int instance = 0, triangle = 0; // of the scene
    vec3 a{0}, b{0}, c{0};          // world corners
    float chance = 0;               // of being picked
    float area = 0;                 // m²
};

struct EmissiveTriangles {
    std::vector<EmissiveTriangle> triangles;
    std::vector<double> cumulative;         // chance of the triangles up to and with each
    std::vector<std::vector<int>> by_shape; // [instance][triangle] -> index above, -1 or empty = none
};

// The opaque triangles whose material emits; null where there are none. Those with holes or alpha are left to be found
// by chance. Made once for as long as the surfaces stay where they are.
std::shared_ptr<const EmissiveTriangles> emissive_triangles(const Snapshot& snapshot);

struct EmissivePoint {
    vec3 position{0}, normal{0}; // of the face
    vec3 emission{0};            // radiance
    float density = 0;           // chance per m²
};
EmissivePoint pick_glow_point(const EmissiveTriangles& glow, const Occluders& surfaces, float u, vec2 v);

// Chance per m² with which pick_glow_point() finds points of a triangle; 0 when it does not glow.
float glow_density(const EmissiveTriangles& glow, int instance, int triangle);
}

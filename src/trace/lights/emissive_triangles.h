// Importance sampling of emissive surfaces: points by area times brightness times opacity, without textures.
#pragma once
#include "base/math.h"

#include <memory>
#include <vector>

namespace tyndall {
class Occluders;
struct CacheKey;
struct Snapshot;

struct EmissiveTriangle {
    int instance = 0, triangle = 0; // of the scene
    vec3 a{0}, b{0}, c{0};          // world corners
    float probability = 0;          // probability of being picked
    float area = 0;                 // m²
};

struct EmissiveTriangles {
    std::vector<EmissiveTriangle> triangles;
    std::vector<double> cumulative;         // probability of the triangles up to and including each
    std::vector<int> casters;               // distinct sets that shadow their light; -1 = all surfaces
    std::vector<std::vector<int>> by_shape; // [instance][triangle] -> index above, -1 or empty = none
};

// Key of what emissive surfaces and their shadows are made from.
CacheKey emission_key(const Snapshot& snapshot);

// The triangles with an emissive material; null if there are none. Cached while surfaces do not move.
std::shared_ptr<const EmissiveTriangles> emissive_triangles(const Snapshot& snapshot);

struct EmissivePoint {
    vec3 position{0}, normal{0}; // of the face
    vec3 emission{0};            // radiance times opacity, as a camera ray sees it: 0 in the holes of a mask
    float pdf = 0;               // 1/m²
    int instance = 0;            // of the scene
};
EmissivePoint sample_triangles(const EmissiveTriangles& emissive, const Occluders& surfaces, float u, vec2 v);

// Pdf, 1/m², with which sample_triangles() picks points of a triangle; 0 if it does not emit.
float triangle_pdf(const EmissiveTriangles& emissive, int instance, int triangle);
}

// Shadow-casting triangles with connectivity: coincident corners become one corner, edges between the same corners one
// edge. A mesh may be open, non-manifold or self-intersecting.
#pragma once
#include "trace/occlusion/occluders.h"

#include <memory>

namespace tyndall {
struct Light;

struct ShadowMesh {
    struct Edge {
        uint32_t a = 0, b = 0; // corners, a < b
    };
    struct Triangle {
        uint32_t corners[3];
        uint32_t edges[3]; // the k-th runs between corners k and k+1
    };
    std::vector<dvec3> corners;
    std::vector<Edge> edges;
    std::vector<Triangle> triangles;
};

// Triangles with alpha and those without area are left out.
ShadowMesh make_shadow_mesh(const std::vector<ShadowTriangle>& triangles);

// The triangles that may shadow what a light reaches, seen from any point of its sphere: those near a spot's cone, and
// within the light's range.
std::shared_ptr<const ShadowMesh> mesh_in_reach(std::shared_ptr<const ShadowMesh> mesh, const Light& light);
}

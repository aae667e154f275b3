// Small surfaces made in memory.
#pragma once
#include "scene/mesh.h"

namespace tyndall {
struct Scene;
struct Node;
}

namespace tyndall::test {
// A parallelogram: corner, and the two edges from it.
Mesh quad(vec3 corner, vec3 a, vec3 b, int material = -1);

Mesh box_mesh(vec3 low, vec3 high, int material = -1);

// Adds the mesh once, at a node of its own when it is to be placed.
void add_mesh(Scene& scene, Mesh mesh);
void add_mesh(Scene& scene, Mesh mesh, const Node& node);

Material blend_material(float alpha);
}

// Small surfaces made in memory.
#pragma once
#include "scene/mesh.h"

namespace tyndall {
struct Scene;
struct Node;
}

namespace tyndall::test {
// Adds the mesh once, at a node of its own when it is to be placed.
void add_mesh(Scene& scene, Mesh mesh);
void add_mesh(Scene& scene, Mesh mesh, const Node& node);

Material blend_material(float alpha);
}

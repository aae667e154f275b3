// Parts of scenes made in memory.
#pragma once
#include "scene/keyed.h"
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

// From a to b in the first second.
template<class T> Keyed<T> from_to(T a, T b) {
    Keyed<T> keyed;
    keyed.times = {0, 1}, keyed.values = {a, b};
    return keyed;
}
}

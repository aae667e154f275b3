// Meshes that change their shape: morph targets, then a skin, as glTF has them (2.0, section 3.7).
#pragma once
#include "base/math.h"

#include <cstddef>
#include <vector>

namespace tyndall {
struct Instance;
struct Mesh;
struct Scene;

// What an instance's shape at a moment follows from. Empty: its mesh as it is.
struct Pose {
    std::vector<float> targets; // weights of the mesh's morph targets
    std::vector<mat4> joints; // from the mesh to where each joint of its skin takes it, counted from the scene's origin

    bool empty() const { return targets.empty() && joints.empty(); }
    bool operator==(const Pose&) const = default;
};
Pose pose_of(const Scene& scene, const Instance& instance, double seconds);

// A vertex in that pose: in the mesh's space, or in the world, counted from the scene's origin, where it has joints.
// Normals have any length; the mesh must have some.
vec3 posed_position(const Mesh& mesh, const Pose& pose, size_t vertex);
vec3 posed_normal(const Mesh& mesh, const Pose& pose, size_t vertex);
Box posed_bounds(const Mesh& mesh, const Pose& pose);

// From the space of its posed positions to the world, counted from the scene's origin: its node's matrix, or the
// identity where joints took them there.
mat4 instance_matrix(const Scene& scene, const Instance& instance, double seconds);

// Whether the scene gives keys to where an instance is or to its shape.
bool is_moving(const Scene& scene, const Instance& instance);
}

// Deforming meshes: morph targets, then skinning, as in glTF (2.0, section 3.7).
#pragma once
#include "base/math.h"

#include <cstddef>
#include <vector>

namespace tyndall {
struct Instance;
struct Mesh;
struct Scene;

// The parameters of an instance's shape at a time. Empty: the mesh is not deformed.
struct Pose {
    std::vector<float> targets; // weights of the mesh's morph targets
    std::vector<mat4> joints;   // skinning matrices, from the mesh to the world relative to the scene's origin

    bool empty() const { return targets.empty() && joints.empty(); }
    bool operator==(const Pose&) const = default;
};
Pose pose_of(const Scene& scene, const Instance& instance, double seconds);

// A vertex in that pose: in mesh space, or with joints in the world relative to the scene's origin. Normals have any
// length; the mesh must have some.
vec3 posed_position(const Mesh& mesh, const Pose& pose, size_t vertex);
vec3 posed_normal(const Mesh& mesh, const Pose& pose, size_t vertex);
Box posed_bounds(const Mesh& mesh, const Pose& pose);

// From posed positions to the world relative to the scene's origin: the node's matrix, or the identity for skinned
// instances, whose joints place them.
mat4 instance_matrix(const Scene& scene, const Instance& instance, double seconds);

// Whether an instance's transform or shape is animated.
bool is_moving(const Scene& scene, const Instance& instance);
}

// A node's place in the world.
#pragma once
#include "base/math.h"

#include <string>

namespace tyndall {
struct Scene;

// A node's position and axes; `forward` is normalized.
struct NodeFrame {
    vec3 position, up, forward;
};

// Throws Error (refused) that begins with `what` if the node's transform is singular or not finite.
NodeFrame node_frame(const Scene& scene, int node, double seconds, const std::string& what);
}

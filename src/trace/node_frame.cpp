#include "trace/node_frame.h"

#include "base/error.h"
#include "scene/scene.h"

namespace tyndall {
NodeFrame node_frame(const Scene& scene, int node, double seconds, const std::string& what) {
    const mat4 matrix = node_matrix(scene, node, seconds);
    const vec3 back(matrix[2]);
    if (!is_finite(vec3(matrix[3])) || !is_finite(back) || !(glm::length(back) > 0))
        refuse(scene.file.string(), what + ": the transform of its node is singular or not finite");
    return {vec3(matrix[3]), vec3(matrix[1]), -glm::normalize(back)};
}
}

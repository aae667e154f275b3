#include "trace/lights/light_frame.h"

#include "scene/scene.h"

namespace tyndall {
NodeFrame light_frame(const Scene& scene, const LightSource& light, double seconds) {
    const auto frame = [](vec3 position, vec3 up, vec3 along) {
        const float length = glm::length(along);
        return NodeFrame{position, up, length > 0 ? along / length : vec3(0)};
    };
    if (light.node < 0) return frame(light.position.at(seconds), light.up.at(seconds), light.direction.at(seconds));
    const mat4 matrix = node_matrix(scene, light.node, seconds);
    return frame(vec3(matrix[3]), vec3(matrix[1]), -vec3(matrix[2]));
}
}

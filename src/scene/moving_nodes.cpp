#include "scene/moving_nodes.h"

namespace tyndall {
bool is_moving(const Scene& scene, int node) {
    for (; node >= 0; node = scene.nodes[static_cast<size_t>(node)].parent) {
        const Node& n = scene.nodes[static_cast<size_t>(node)];
        if (n.matrix) continue;
        if (!n.translation.constant() || !n.rotation.constant() || !n.scale.constant()) return true;
    }
    return false;
}
}

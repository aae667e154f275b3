#include "measure/stress/volumes.h"

#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include "base/random.h"

namespace tyndall {
StressScene looking_at(Medium medium) {
    return stress_scene({std::move(medium)}, {noon_light}, camera_from({0.6f, 0.7f, 2.6f}, vec3(0.5f)));
}

float blob(vec3 p) { return std::exp(-24 * glm::dot(p - 0.5f, p - 0.5f)); }
float roughness(vec3 p) {
    const glm::uvec3 cell(p * 16.0f);
    return std::max(0.0f, 2 * to_unit(hash(cell.x, cell.y, cell.z)) - 0.6f);
}
}

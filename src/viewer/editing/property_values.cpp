// Values of properties at a time: of keyframes, of lights on glTF nodes, and far from the origin.
#include "scene/scene.h"
#include "viewer/editing/properties.h"

namespace tyndall {
namespace {
// Slots also serve for reading; nothing is written through this one.
Slot slot_of(const Scene& scene, const Property& property, size_t index) {
    return property.slot(const_cast<Scene&>(scene), index);
}

// The stated focus distance, or else the target's.
float focus_at(const Scene& scene, size_t camera, double seconds) {
    const CameraSource& source = scene.cameras[camera];
    return source.focus ? source.focus->at(seconds)
                        : glm::distance(source.position.at(seconds), source.target.at(seconds));
}
}

LightPlacement light_placement(const Scene& scene, size_t light, double seconds) {
    const LightSource& source = scene.lights[light];
    if (source.node < 0) {
        const vec3 direction = source.direction.at(seconds);
        const float length = glm::length(direction);
        return {source.position.at(seconds), length > 0 ? direction / length : vec3(0, -1, 0), source.up.at(seconds)};
    }
    const mat4 matrix = node_matrix(scene, source.node, seconds);
    const vec3 back(matrix[2]);
    return {vec3(matrix[3]), glm::length(back) > 0 ? -glm::normalize(back) : vec3(0, -1, 0), vec3(matrix[1])};
}

vec3 value_at(const Scene& scene, const Property& property, size_t index, double seconds) {
    const std::string_view name = property.name;
    if (property.part == Part::light && scene.lights[index].node >= 0 && property.is_placement()) {
        const LightPlacement place = light_placement(scene, index, seconds);
        return name == "position" ? place.position + vec3(scene.origin) : name == "up" ? place.up : place.direction;
    }
    const Slot slot = slot_of(scene, property, index);
    vec3 value(0);
    if (const auto* number = std::get_if<Keyed<float>*>(&slot)) value.x = (*number)->at(seconds);
    if (const auto* vector_value = std::get_if<Keyed<vec3>*>(&slot)) value = (*vector_value)->at(seconds);
    if (std::holds_alternative<std::optional<Keyed<float>>*>(slot)) value.x = focus_at(scene, index, seconds);
    if (const auto* number = std::get_if<float*>(&slot)) value.x = **number;
    if (const auto* vector_value = std::get_if<vec3*>(&slot)) value = **vector_value;
    if (const auto* flag = std::get_if<bool*>(&slot)) value.x = **flag;
    if (property.is_position() && scene.origin != dvec3(0)) {
        const vec3 origin(scene.origin);
        value += property.kind == ValueKind::number ? vec3(origin.y, 0, 0) : origin;
    }
    return property.is_angle() ? glm::degrees(value) : value;
}

bool is_keyed(const Scene& scene, const Property& property, size_t index) {
    const Slot slot = slot_of(scene, property, index);
    if (const auto* number = std::get_if<Keyed<float>*>(&slot)) return !(*number)->times.empty();
    if (const auto* vector_value = std::get_if<Keyed<vec3>*>(&slot)) return !(*vector_value)->times.empty();
    if (const auto* maybe = std::get_if<std::optional<Keyed<float>>*>(&slot))
        return **maybe && !(**maybe)->times.empty();
    return false;
}
}

#include "scene/file/origin.h"

#include "scene/scene.h"

#include <optional>

namespace tyndall {
namespace {
constexpr double far_out = 64; // smallest ratio of distance from the world's origin to size of the view that is far

// What the camera views: its position and size.
struct Sight {
    dvec3 location;
    double size;
};

bool is_placed(const Field& camera) { return camera.member("position") && camera.member("target"); }

// The entry that read_cameras() makes the default camera; empty if that is a camera of the glTF, with or without an
// added lens.
Field camera_field(const Field& root) {
    if (!root) return {};
    const Field chosen = root.member("camera"), cameras = root.member("cameras");
    if (chosen && chosen.json->kind == Json::Kind::object) return is_placed(chosen) ? chosen : Field{};
    for (size_t i = 0; cameras && i < cameras.json->items.size(); ++i)
        if (is_placed(cameras.item(i)) &&
            (!chosen || cameras.item(i).json->string_or("name", "") == chosen.json->string))
            return cameras.item(i);
    return {};
}

Sight sight_of(const Field& camera) {
    const dvec3 position = read_position(camera.member("position"));
    return {position, glm::length(read_position(camera.member("target")) - position)};
}

std::optional<Sight> sight_of(const Field& root, const Scene& scene) {
    const Box bounds = scene_bounds(scene, 0);
    if (bounds.empty()) return {};
    const double size = glm::length(dvec3(bounds.size()));
    const Field chosen = root ? root.member("camera") : Field{};
    const std::string name = chosen ? chosen.json->string_or("name", chosen.json->string) : "";
    for (const CameraSource& camera : scene.cameras)
        if (!chosen || camera.name == name) return Sight{dvec3(world_matrix(scene, camera.node, 0)[3]), size};
    return Sight{dvec3(bounds.center()), size};
}
}

dvec3 far_origin(const Field& root, const Scene& scene) {
    const Field camera = camera_field(root);
    const std::optional<Sight> sight = camera ? sight_of(camera) : sight_of(root, scene);
    if (!sight || !(sight->size > 0)) return dvec3(0);
    const dvec3 away = glm::abs(sight->location);
    if (!(std::max({away.x, away.y, away.z}) > far_out * sight->size)) return dvec3(0);

    // A multiple of a power of two, so that adding it back is exact.
    const double step = std::exp2(std::ceil(std::log2(sight->size)));
    return glm::round(sight->location / step) * step;
}
}

#include "scene/file/stand_ins.h"

#include "base/text.h"
#include "scene/file/scene_file.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace tyndall {
void add_missing_camera(Scene& scene) {
    if (!scene.cameras.empty()) return;
    CameraSource camera;
    camera.name = "default";
    camera.vertical_fov = glm::radians(45.0f);
    const Box bounds = scene_bounds(scene, 0);
    if (!bounds.empty()) {
        // Far enough for the bounding sphere to fit in an image at least as wide as high.
        const float radius = std::max(0.5f * glm::length(bounds.size()), 1e-3f);
        const float distance = 1.05f * radius / std::sin(0.5f * camera.vertical_fov.values[0]);
        camera.target = bounds.center();
        camera.position = bounds.center() + distance * glm::normalize(vec3(0.45f, 0.3f, 1.0f));
        camera.near = std::min(camera.near, 1e-3f * distance);
    }
    scene.cameras.push_back(camera);
    warn(scene, scene.file.string() + ": there is no camera; one that sees everything is used");
}

void add_missing_light_and_fog(Scene& scene) {
    const std::string file = scene.file.string();
    Box bounds = scene_bounds(scene, 0);
    if (bounds.empty()) bounds = {vec3(-5), vec3(5)};

    if (scene.lights.empty()) {
        LightSource sun;
        sun.name = "default sun", sun.kind = LightKind::sun;
        sun.direction = glm::normalize(vec3(-0.5f, -0.7f, -0.4f));
        sun.intensity = 3.0f;
        scene.lights.push_back(sun);
        scene.ambient = vec3(0.1f);
        warn(scene, file + ": there is no light; a sun of 3 lux and some ambient light are used");
    }

    // Haze without a visible edge, through which half the light passes over twice the scene's diagonal. It ends far
    // away, so that light from a low sun gets through.
    const float diagonal = std::max(glm::length(bounds.size()), 1e-3f);
    MediumSource fog;
    fog.name = "default fog", fog.kind = MediumKind::height;
    fog.extinction = 0.7f / (2 * diagonal);
    fog.g = 0.3f;
    fog.height_base = bounds.low.y, fog.height_falloff = 0.5f * diagonal;
    fog.bounds = {bounds.low - 3 * diagonal, bounds.high + 3 * diagonal};
    scene.media.push_back(fog);
    warn(scene, file + ": a glTF has no fog; height fog with an extinction of " +
                    formatted("%.3g", fog.extinction.values[0]) + " per meter is used");
}
}

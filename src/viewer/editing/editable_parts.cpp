#include "viewer/editing/editable_parts.h"

namespace tyndall {
EditableParts editable_parts(const Scene& scene) {
    return {scene.lights,       scene.media,   scene.cameras,   scene.exposure,
            scene.own_exposure, scene.ambient, scene.background};
}

void put_parts(const EditableParts& parts, Scene& scene) {
    scene.lights = parts.lights, scene.media = parts.media, scene.cameras = parts.cameras;
    scene.exposure = parts.exposure, scene.own_exposure = parts.own_exposure;
    scene.ambient = parts.ambient, scene.background = parts.background;
}
}

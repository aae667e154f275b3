// The parts of a scene that edits can change, without the rest, which may be large.
#pragma once
#include "scene/scene.h"

namespace tyndall {
struct EditableParts {
    std::vector<LightSource> lights;
    std::vector<MediumSource> media;
    std::vector<CameraSource> cameras;
    Keyed<float> exposure;
    bool own_exposure = false;
    Keyed<vec3> ambient;
    Background background;
};

EditableParts editable_parts(const Scene& scene);
void put_parts(const EditableParts& parts, Scene& scene);
}

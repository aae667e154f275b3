// Scales lengths, and quantities per length, throughout a scene.
#include "measure/verify/scaled_scene.h"

namespace tyndall {
namespace {
template<class T> void scale(Keyed<T>& keyed, float factor) {
    for (T& value : keyed.values) value *= factor;
}

void scale_light(LightSource& light, float factor) {
    scale(light.position, factor), scale(light.radius, factor);
    scale(light.width, factor), scale(light.height, factor);
    scale(light.range, factor);
    const bool per_area = is_distant(light) || (has_area(light) && light.unit == LightUnit::native); // lux or nits
    if (!per_area) scale(light.intensity, factor * factor);
}

void scale_medium(MediumSource& medium, float factor) {
    scale(medium.translation, factor), scale(medium.scale, factor);
    scale(medium.height_base, factor), scale(medium.height_falloff, factor);
    scale(medium.extinction, 1 / factor), scale(medium.emission, 1 / factor);
    if (medium.blackbody && !medium.blackbody->by_absorption) scale(medium.blackbody->scale, 1 / factor);
}
}

Scene scaled(Scene scene, float factor) {
    for (Node& node : scene.nodes) {
        scale(node.translation, factor);
        if (node.matrix) (*node.matrix)[3] *= vec4(vec3(factor), 1);
    }
    for (Mesh& mesh : scene.meshes) {
        for (vec3& position : mesh.positions) position *= factor;
        for (MorphTarget& target : mesh.targets)
            for (vec3& offset : target.positions) offset *= factor;
    }
    for (Skin& skin : scene.skins)
        for (mat4& matrix : skin.inverse_bind) matrix[3] *= vec4(vec3(factor), 1);
    for (CameraSource& camera : scene.cameras) {
        scale(camera.position, factor), scale(camera.target, factor);
        camera.near *= factor, camera.far *= factor;
        scale(camera.ortho_height, factor), scale(camera.aperture, factor);
        if (camera.focus) scale(*camera.focus, factor);
    }
    for (LightSource& light : scene.lights) scale_light(light, factor);
    for (MediumSource& medium : scene.media) scale_medium(medium, factor);
    for (Billboard& card : scene.billboards)
        card.from *= factor, card.to *= factor, card.width_from *= factor, card.width_to *= factor;
    return scene;
}
}

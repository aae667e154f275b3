// The cameras of a scene file, and which one is the default.
#include "base/text.h"
#include "scene/file/scene_file.h"

namespace tyndall {
namespace {
void check_aim(const CameraSource& camera, const Field& field) {
    if (camera.position.constant() && camera.target.constant() && camera.position.values[0] == camera.target.values[0])
        refuse(field.member("target"), "is where the camera stands: there is no direction to look in");
    for (const vec3 up : camera.up.values)
        if (up == vec3(0)) refuse(field.member("up"), "has no direction: its length is 0");
}

CameraSource camera_source(const Field& field, std::string_view default_name, dvec3 origin) {
    CameraSource camera;
    camera.name = field.json->string_or("name", default_name);
    camera.entry = field.pointer;
    camera.position = keyed_place(field.member("position"), origin);
    camera.target = keyed_place(field.member("target"), origin);
    if (const Field up = field.member("up")) camera.up = keyed_vector(up);
    check_aim(camera, field);

    camera.vertical_fov = glm::radians(45.0f);
    const Field fov = field.member("vertical_fov"), height = field.member("ortho_height");
    if (fov && height) refuse(height, "and vertical_fov exclude each other: a camera is orthographic or not");
    if (fov) camera.vertical_fov = keyed_degrees(fov);
    if (height) camera.ortho_height = read_number(height);
    if (const Field near = field.member("near")) camera.near = read_number(near);
    if (const Field far = field.member("far")) {
        camera.far = read_number(far);
        if (camera.far <= camera.near) refuse(far, "must be greater than near");
    }
    return camera;
}

std::vector<std::string> camera_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const CameraSource& camera : scene.cameras) names.push_back(camera.name);
    return names;
}

int index_of(const Scene& scene, std::string_view name) {
    const std::vector<std::string> names = camera_names(scene);
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

void add(const CameraSource& camera, const Field& field, Scene& scene) {
    if (index_of(scene, camera.name) >= 0)
        refuse(field.member("name") ? field.member("name") : field,
               "another camera has the name \"" + camera.name + "\" already");
    scene.cameras.push_back(camera);
}
}

void read_cameras(const Field& root, Scene& scene) {
    const int first_here = static_cast<int>(scene.cameras.size());
    if (const Field cameras = root.member("cameras"))
        for (size_t i = 0; i < cameras.json->items.size(); ++i) {
            const Field field = cameras.item(i);
            if (!field.member("name")) refuse(field, "a camera in a list needs a name");
            add(camera_source(field, "", scene.origin), field, scene);
        }
    if (static_cast<int>(scene.cameras.size()) > first_here) scene.camera = first_here;

    const Field chosen = root.member("camera");
    if (!chosen) return;
    if (chosen.json->kind == Json::Kind::object) {
        add(camera_source(chosen, "camera", scene.origin), chosen, scene);
        scene.camera = static_cast<int>(scene.cameras.size()) - 1;
        return;
    }
    scene.camera = index_of(scene, chosen.json->string);
    if (scene.camera >= 0) return;
    refuse(chosen, unknown_name("camera", chosen.json->string, camera_names(scene)));
}
}

// The cameras of a scene file, lenses and shutters on those of the glTF, and which one is the default.
#include "base/text.h"
#include "scene/file/scene_file.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
void check_aim(const CameraSource& camera, const Field& field) {
    if (camera.position.constant() && camera.target.constant() && camera.position.values[0] == camera.target.values[0])
        refuse(field.member("target"), "is the same point as position: the camera has no viewing direction");
    for (const vec3 up : camera.up.values)
        if (up == vec3(0)) refuse(field.member("up"), "has no direction: its length is 0");
}

// The lens: fields that may also be given for a camera of the glTF.
void read_lens(const Field& field, CameraSource& camera) {
    const Field aperture = field.member("aperture_radius"), focus = field.member("focus_distance");
    const Field blades = field.member("aperture_blades"), turn = field.member("blade_rotation");
    for (const Field& given : {focus, blades, turn})
        if (given && !aperture) refuse(given, "has no effect without aperture_radius");
    if (turn && !blades) refuse(turn, "has no effect without aperture_blades");
    if (!aperture) return;
    if (is_orthographic(camera)) refuse(aperture, "is for perspective cameras only; this one is orthographic");
    if (!focus && camera.node >= 0) refuse(field, "needs focus_distance: a camera of the glTF has no target");
    camera.aperture = keyed_number(aperture);
    if (focus) camera.focus = keyed_number(focus);
    if (blades) camera.blades = static_cast<int>(read_number(blades));
    if (turn) camera.blade_rotation = keyed_degrees(turn);
}

// A named curve, or transmissions at equally spaced times.
std::vector<float> shutter_curve(const Field& field) {
    if (field.json->kind == Json::Kind::string)
        return field.json->string == "triangle" ? std::vector<float>{0, 1, 0} : std::vector<float>{};
    std::vector<float> curve;
    for (size_t i = 0; i < field.json->items.size(); ++i) curve.push_back(read_number(field.item(i)));
    if (std::ranges::all_of(curve, [](float value) { return value == 0; }))
        refuse(field, "is 0 at all times: the shutter lets no light in");
    return curve;
}

void read_shutter(const Field& field, CameraSource& camera) {
    if (!field) return;
    Shutter& shutter = camera.shutter;
    shutter.open = field.member("open") ? field.member("open").json->number : 0;
    shutter.close = field.member("close").json->number;
    if (shutter.close < shutter.open)
        refuse(field, formatted("closes before it opens: open is %g, close is %g", shutter.open, shutter.close));
    if (const Field curve = field.member("curve")) shutter.curve = shutter_curve(curve);
}

// What may also be given for a camera of the glTF.
void read_exposing(const Field& field, CameraSource& camera) {
    read_lens(field, camera);
    read_shutter(field.member("shutter"), camera);
}

CameraSource camera_source(const Field& field, std::string_view default_name, dvec3 origin) {
    CameraSource camera;
    for (const char* key : {"position", "target"})
        if (!field.member(key)) refuse(field, "missing key " + quote_json(key));
    camera.name = field.json->string_or("name", default_name);
    camera.entry = field.pointer;
    camera.position = keyed_position(field.member("position"), origin);
    camera.target = keyed_position(field.member("target"), origin);
    if (const Field up = field.member("up")) camera.up = keyed_vector(up);
    check_aim(camera, field);

    camera.vertical_fov = glm::radians(45.0f);
    const Field fov = field.member("vertical_fov"), height = field.member("ortho_height");
    if (fov && height) refuse(height, "cannot be combined with vertical_fov: a camera is orthographic or perspective");
    if (fov) camera.vertical_fov = keyed_degrees(fov);
    if (height) camera.ortho_height = keyed_number(height);
    if (const Field near = field.member("near")) camera.near = read_number(near);
    if (const Field far = field.member("far")) {
        camera.far = read_number(far);
        if (camera.far <= camera.near) refuse(far, "must be greater than near");
    }
    read_exposing(field, camera);
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

// The camera of the glTF to which an entry adds a lens or a shutter: it has the same name, and the entry has no other
// fields.
CameraSource* under_lens(const Field& field, Scene& scene) {
    const int known = index_of(scene, field.json->string_or("name", ""));
    if (known < 0 || scene.cameras[static_cast<size_t>(known)].node < 0) return nullptr;
    const auto of_lens = [](const auto& member) {
        return std::ranges::count(std::array{"name", "aperture_radius", "focus_distance", "aperture_blades",
                                             "blade_rotation", "shutter"},
                                  member.first) > 0;
    };
    return std::ranges::all_of(field.json->members, of_lens) ? &scene.cameras[static_cast<size_t>(known)] : nullptr;
}

void add(const CameraSource& camera, const Field& field, Scene& scene) {
    if (index_of(scene, camera.name) >= 0)
        refuse(field.member("name") ? field.member("name") : field,
               "another camera already has the name \"" + camera.name + "\"");
    scene.cameras.push_back(camera);
}
}

void read_cameras(const Field& root, Scene& scene) {
    const int first_here = static_cast<int>(scene.cameras.size());
    if (const Field cameras = root.member("cameras"))
        for (size_t i = 0; i < cameras.json->items.size(); ++i) {
            const Field field = cameras.item(i);
            if (!field.member("name")) refuse(field, "a camera in a list needs a name");
            if (CameraSource* known = under_lens(field, scene))
                read_exposing(field, *known);
            else
                add(camera_source(field, "", scene.origin), field, scene);
        }
    if (static_cast<int>(scene.cameras.size()) > first_here) scene.camera = first_here;

    const Field chosen = root.member("camera");
    if (!chosen) return;
    if (chosen.json->kind == Json::Kind::object) {
        if (CameraSource* known = under_lens(chosen, scene)) {
            read_exposing(chosen, *known);
            scene.camera = static_cast<int>(known - scene.cameras.data());
            return;
        }
        add(camera_source(chosen, "camera", scene.origin), chosen, scene);
        scene.camera = static_cast<int>(scene.cameras.size()) - 1;
        return;
    }
    scene.camera = index_of(scene, chosen.json->string);
    if (scene.camera >= 0) return;
    refuse(chosen, unknown_name("camera", chosen.json->string, camera_names(scene)));
}
}

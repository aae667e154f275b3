#include "viewer/fixtures.h"

#include "scene/camera.h"
#include "scene/scene.h"
#include "trace/moment.h"
#include "viewer/editing/scene_loader.h"
#include "viewer/state/view_state.h"

namespace tyndall::test {
CameraSource camera_source(const char* name, vec3 position, vec3 target) {
    CameraSource camera;
    camera.name = name;
    camera.position = Keyed<vec3>(position), camera.target = Keyed<vec3>(target);
    return camera;
}

std::shared_ptr<Scene> small_scene(const std::filesystem::path& file) {
    Scene scene;
    scene.file = file;
    scene.resolution = {64, 40};
    scene.first_frame = 1, scene.last_frame = 4;
    scene.cameras = {camera_source("front", {0, 1, 4}, {0, 1, 0}), camera_source("side", {4, 1, 0}, {0, 1, 0})};
    scene.cameras[1].position.times = {0, 1}, scene.cameras[1].position.values = {vec3(4, 1, 0), vec3(4, 2, 0)};
    LightSource sun;
    sun.name = "sun", sun.kind = LightKind::sun;
    sun.direction = Keyed<vec3>(vec3(-0.3f, -1, -0.2f)), sun.intensity = Keyed<float>(4);
    scene.lights = {sun};
    MediumSource fog;
    fog.name = "haze", fog.extinction = Keyed<float>(0.2f);
    fog.bounds = {vec3(-3), vec3(3)};
    scene.media = {fog};
    Mesh mesh;
    mesh.positions = {{-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}, {-1, 2, -1}, {1, 2, -1}, {0, 2, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 6, 5}};
    mesh.material = 0;
    Material material;
    material.base_color = vec3(0.5f);
    scene.meshes = {mesh}, scene.materials = {material};
    scene.nodes = {Node{}};
    scene.instances = {{0, 0}};
    return std::make_shared<Scene>(std::move(scene));
}

LoadedScene loaded(const Scene& scene) {
    auto session = std::make_shared<SceneSession>();
    session->scene = scene, session->before = editable_parts(scene);
    auto render_copy = std::make_shared<Scene>(scene);
    return {scene.file, std::move(session), std::move(render_copy), {}, ExitCode::ok};
}

void take_scene(ViewState& state, const std::shared_ptr<Scene>& scene) { take_scene(state, loaded(*scene)); }

void act(ViewState& state, const char* line) { apply(state, parse_action(line)); }

Request request_for(std::shared_ptr<Scene> scene, const char* mode) {
    Request request;
    request.scene = std::move(scene);
    request.revision = 1;
    request.size = request.scene->resolution;
    request.camera = camera_at(*request.scene, 0, 0);
    request.mode = mode;
    request.settings = settings_for(Quality::preview);
    request.max_samples = 12, request.shown.exposure = 0;
    return request;
}
}

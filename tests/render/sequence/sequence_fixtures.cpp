#include "render/sequence/sequence_fixtures.h"

#include "base/io/file.h"
#include "modes/mode.h"
#include "scene/scene.h"

#include <fstream>

namespace tyndall::test {
Scene moving_scene(const TempFolder& directory) {
    Scene scene;
    scene.file = directory.file("scene.json");
    std::ofstream(scene.file) << "{}";
    scene.inputs = {{scene.file, content_hash("{}")}};
    scene.resolution = {40, 30};
    CameraSource camera;
    camera.name = "main";
    camera.position.times = {0, 1};
    camera.position.values = {vec3(0, 0, 0), vec3(1, 0.5f, 0)};
    camera.target.values = {vec3(0, 0, -5)};
    scene.cameras = {camera};
    add_plane(scene, -3, 1, vec3(2, 1, 0.5f));
    add_plane(scene, -2, 0.5f, vec3(0, 1, 0), 0.5f);
    MediumSource fog;
    fog.name = "haze";
    fog.extinction = Keyed<float>(0.2f);
    scene.media = {fog};
    LightSource light;
    light.name = "sun", light.kind = LightKind::sun;
    light.direction.values = {vec3(0, -1, -1)};
    scene.lights = {light};
    scene.background.color = Keyed<vec3>(vec3(0.1f, 0.2f, 0.4f));
    return scene;
}

RenderRequest job_for(const Scene& scene, const std::string& output, std::vector<int> frames) {
    RenderRequest job;
    job.scene_file = scene.file;
    job.output = output;
    job.frames = std::move(frames);
    job.mode = "test";
    job.settings = settings_for(Quality::draft);
    job.isa = "avx2";
    return job;
}

RenderReport run(const Scene& scene, const RenderRequest& job) { return run(scene, job, mode_of(prepare_everything)); }

RenderReport run(const Scene& scene, const RenderRequest& job, const Mode& mode) {
    Progress progress(ProgressStyle::none, "render", static_cast<double>(job.frames.size()));
    std::atomic<bool> cancel = false;
    return render_sequence(scene, job, {&mode, job.settings, {}, {}, {}, {}}, progress, cancel);
}

}

#include "render/fixtures.h"

#include "base/random.h"
#include "modes/limitation.h"
#include "modes/mode.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

namespace tyndall::test {
void add_plane(Scene& scene, float z, float half, vec3 emission, float alpha) {
    Material material;
    material.base_color = vec3(0), material.emission = emission, material.alpha = alpha;
    material.alpha_mode = alpha < 1 ? AlphaMode::blend : AlphaMode::opaque;
    Mesh mesh;
    mesh.positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.instances.push_back({-1, static_cast<int>(scene.meshes.size())});
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
}

Camera plain_camera(float ortho_height) {
    Camera camera;
    camera.position = vec3(0);
    camera.ortho_height = ortho_height;
    return camera;
}

View plain_view(ivec2 size, int samples, float ortho_height) {
    View view;
    view.camera = plain_camera(ortho_height);
    view.size = size, view.pixel_samples = samples;
    view.filter = PixelFilter::box, view.filter_radius = 0.5f;
    return view;
}

Snapshot snapshot_of(const Scene& scene) { return snapshot_of(scene, {}); }

Snapshot snapshot_of(const Scene& scene, std::vector<Medium> media) {
    Snapshot snapshot;
    snapshot.scene = &scene;
    snapshot.media = std::move(media);
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    snapshot.bounds = snapshot.occluders->bounds();
    return snapshot;
}

Limitations no_limitations(const View&, const Snapshot&, const Settings&) { return {}; }

Mode mode_of(ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*)) {
    return {"test", "a mode of the tests", "tests", Accuracy::artistic, Surfaces::shared, no_limitations, prepare};
}

ScatterFunction prepare_emissive(const View&, const Snapshot& snapshot, const Settings&, History*) {
    const float extinction = snapshot.media.empty() ? 0 : gray_extinction(snapshot.media[0].optics);
    return [extinction, lights = snapshot.lights.size()](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < batch.rays.size(); ++i) {
            const float transmittance = std::exp(-extinction * batch.rays[i].t_max);
            results[i] = {fog_radiance * (1 - transmittance), transmittance, 1, 3};
            for (size_t l = 0; l < lights && !batch.parts.empty(); ++l)
                batch.part(i, l) = results[i].radiance / static_cast<float>(lights);
        }
    };
}

ScatterFunction prepare_nothing(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); };
}

ScatterFunction prepare_everything(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        uint32_t all = static_cast<uint32_t>(batch.rays.size());
        for (const uint32_t id : batch.ids) all = hash(all, id);
        for (const float jitter : batch.jitter) all = hash(all, static_cast<uint32_t>(jitter * 65536));
        for (size_t i = 0; i < results.size(); ++i) {
            const vec3 d = batch.rays[i].direction, o = batch.rays[i].origin;
            const float random = to_unit(hash(all, batch.ids[i]));
            results[i] = {glm::abs(d) * random + glm::abs(o), 0.5f + 0.5f * batch.jitter[i], random, 1, {}};
        }
    };
}
}

// Scenes of a few planes, and modes of one line, so that every pixel has a closed form.
#pragma once
#include "base/error.h"
#include "base/file.h"
#include "base/random.h"
#include "modes/mode.h"
#include "modes/promise.h"
#include "render/frame.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace tyndall::test {
// A directory of its own, removed afterwards.
struct TemporaryDirectory {
    std::filesystem::path path;

    TemporaryDirectory() {
        static std::atomic<int> count = 0;
        path = std::filesystem::temp_directory_path() /
               ("tyndall_render_" + std::to_string(getpid()) + "_" + std::to_string(count++));
        std::filesystem::create_directories(path);
    }
    ~TemporaryDirectory() { std::filesystem::remove_all(path); }
    std::string file(const std::string& name) const { return (path / name).string(); }
    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const auto& entry : std::filesystem::directory_iterator(path)) result.push_back(entry.path().filename());
        std::ranges::sort(result);
        return result;
    }
};

// Runs `body`, which has to throw an Error of this code; returns its text.
template<class Body> std::string error_text(ExitCode code, const Body& body) {
    try {
        body();
    } catch (const Error& error) {
        EXPECT_EQ(static_cast<int>(error.code), static_cast<int>(code)) << error.what();
        EXPECT_LE(std::string(error.what()).size(), 500u);
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
}

// A square of side 2·half in the plane z, facing +z, glowing with `emission`.
inline void add_plane(Scene& scene, float z, float half, vec3 emission, float alpha = 1) {
    Material material;
    material.base_color = vec3(0), material.emission = emission, material.alpha = alpha;
    material.alpha_mode = alpha < 1 ? AlphaMode::blend : AlphaMode::opaque;
    material.double_sided = true;
    Mesh mesh;
    mesh.positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.instances.push_back({-1, static_cast<int>(scene.meshes.size())});
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
}

// Looks along -z from the origin.
inline Camera plain_camera(float ortho_height = 0) {
    Camera camera;
    camera.position = vec3(0);
    camera.ortho_height = ortho_height;
    return camera;
}

inline View plain_view(ivec2 size, int samples, float ortho_height = 0) {
    View view;
    view.camera = plain_camera(ortho_height);
    view.size = size, view.pixel_samples = samples;
    view.filter = PixelFilter::box, view.filter_radius = 0.5f;
    return view;
}

// A moment of a scene made by hand; the scene has to outlive it.
inline Snapshot snapshot_of(const Scene& scene, std::vector<Medium> media = {}) {
    Snapshot snapshot;
    snapshot.scene = &scene;
    snapshot.media = std::move(media);
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    snapshot.bounds = snapshot.occluders->bounds();
    return snapshot;
}

inline Medium even_medium(float extinction, Box box = everywhere()) {
    Medium medium;
    medium.optics.extinction = extinction;
    medium.bounds = medium.world_bounds = box;
    return medium;
}

inline std::vector<Limit> no_limits(const View&, const Snapshot&, const Settings&) { return {}; }

inline Mode mode_of(ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*)) {
    return {"test", "a mode of the tests", Accuracy::look, Surfaces::shared, no_limits, prepare};
}

// Fog of the first medium's extinction all along the ray, glowing so that endless fog has radiance `glow`. Each light
// is said to give an equal part.
inline constexpr vec3 glow{0.5f, 0.25f, 1.0f};

inline ScatterFunction prepare_glow(const View&, const Snapshot& snapshot, const Settings&, History*) {
    const float extinction = snapshot.media.empty() ? 0 : snapshot.media[0].optics.extinction;
    return [extinction, lights = snapshot.lights.size()](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < batch.rays.size(); ++i) {
            const float transmittance = std::exp(-extinction * batch.rays[i].t_max);
            results[i] = {glow * (1 - transmittance), transmittance, 1, 3};
            for (size_t l = 0; l < lights && !batch.per_light.empty(); ++l)
                batch.per_light[i * lights + l] = results[i].radiance / static_cast<float>(lights);
        }
    };
}

inline ScatterFunction prepare_nothing(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); };
}

// Light that depends on everything a mode is told, neighbours included.
inline ScatterFunction prepare_everything(const View&, const Snapshot&, const Settings&, History*) {
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

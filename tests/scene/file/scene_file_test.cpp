#include "base/io/file.h"
#include "scene/images.h"
#include "support/gltf_builder.h"
#include "support/load_answer.h"
#include "support/scratch.h"
#include "volume/vdb/vdb.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

namespace tyndall {
namespace {
Scene loaded(const TempFolder& folder, const std::string& text) {
    const LoadResult answer = load(folder.put("scene.json", text));
    EXPECT_TRUE(answer.loaded) << answer.message;
    return answer.scene;
}

TEST(SceneFile, TheLeastThatIsAScene) {
    const TempFolder folder;
    const Scene scene = loaded(folder, R"({"tyndall": 1})");
    EXPECT_EQ(scene.frame_rate, 24);
    EXPECT_EQ(scene.first_frame, 1);
    EXPECT_EQ(scene.resolution, ivec2(640, 360));
    EXPECT_EQ(scene.cameras.size(), 1u) << "one is made up";
    EXPECT_TRUE(has_warning(scene, "no camera"));
    EXPECT_TRUE(has_warning(scene, "no light"));
    EXPECT_FALSE(has_warning(loaded(folder, R"({"tyndall": 1, "ambient": 1})"), "no light"));
    ASSERT_EQ(scene.inputs.size(), 1u);
    EXPECT_EQ(scene.inputs[0].path, folder / "scene.json");
    EXPECT_EQ(scene.inputs[0].hash, content_hash(R"({"tyndall": 1})"));
}

TEST(SceneFile, TextThatIsNoFileYetIsReadAsIfItWereOne) {
    const TempFolder folder;
    const std::string text = R"({"tyndall": 1, "lights": [{"name": "a", "type": "sun", "direction": [0, -1, 0],
        "intensity": 1}], "media": [{"type": "noise", "recipe": "fog/dust.json"}]})";
    folder.put("fog/dust.json", R"({"bounds": {"low": [0, 0, 0], "high": [1, 1, 1]}, "voxel_size": 0.1})");
    EXPECT_THROW(load_scene_text("{", folder / "no.json"), Error);
    EXPECT_THROW(load_scene_text(R"({"tyndall": 2})", folder / "no.json"), Error);
    const Scene scene = load_scene_text(text, folder / "no.json"), other = loaded(folder, text);
    EXPECT_EQ(scene.file, folder / "no.json");
    ASSERT_EQ(scene.inputs.size(), 1u);
    EXPECT_EQ(scene.inputs[0].path, folder / "fog/dust.json");
    EXPECT_EQ(scene.warnings.size(), other.warnings.size());
    EXPECT_EQ(scene.lights[0].entry, "/lights/0");
    EXPECT_EQ(scene.media[0].entry, "/media/0");
    EXPECT_EQ(scene.cameras[0].entry, "") << "made up";
}

TEST(SceneFile, GeneralFields) {
    const TempFolder folder;
    const Scene scene = loaded(folder, R"({"tyndall": 1, "frame_rate": 25, "frames": "-4--2", "resolution": [320, 200],
        "exposure": {"keys": [[0, 1], [2, 3]], "interpolation": "smooth"}, "ambient": 0.25 // comments are fine
    })");
    EXPECT_EQ(scene.frame_rate, 25);
    EXPECT_EQ(scene.first_frame, -4);
    EXPECT_EQ(scene.last_frame, -2);
    EXPECT_EQ(scene.resolution, ivec2(320, 200));
    EXPECT_FLOAT_EQ(scene.exposure.at(1), 2);
    EXPECT_EQ(scene.ambient.at(0), vec3(0.25f));
}

TEST(SceneFile, Cameras) {
    const TempFolder folder;
    const std::string list =
        R"("cameras": [{"name": "wide", "position": [0, 1, 5], "target": [0, 1, 0], "vertical_fov": 90},
        {"name": "plan", "position": [0, 9, 0], "target": [0, 0, 0], "up": [0, 0, -1], "ortho_height": 12, "near": 1, "far": 20}])";
    const Scene scene = loaded(folder, R"({"tyndall": 1, "camera": "plan", )" + list + "}");
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.camera, 1);
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov.at(0), pi / 2);
    EXPECT_EQ(scene.cameras[1].ortho_height.at(0), 12);
    EXPECT_EQ(scene.cameras[1].far, 20);
    EXPECT_EQ(scene.cameras[1].up.at(0), vec3(0, 0, -1));
    EXPECT_EQ(loaded(folder, R"({"tyndall": 1, )" + list + "}").camera, 0);
    const Scene own =
        loaded(folder, R"({"tyndall": 1, "camera": {"position": [1, 2, 3], "target": [0, 0, 0]}, )" + list + "}");
    EXPECT_EQ(own.cameras[own.camera].position.at(0), vec3(1, 2, 3));
}

TEST(SceneFile, Lights) {
    const TempFolder folder;
    const Scene scene = loaded(folder, R"({"tyndall": 1, "lights": [
        {"name": "key", "type": "spot", "position": [0, 5, 0], "target": [3, 1, 0], "color": [1, 0.5, 0.25], "intensity": 800,
         "inner_cone": 10, "outer_cone": 20, "range": 40, "radius": 0.1, "volume_scale": 2, "surface_scale": 0.5},
        {"type": "sun", "direction": [0, -2, 0], "intensity": 10, "angle": 0.27, "shadows": false},
        {"type": "point", "position": {"keys": [[0, [0, 0, 0]], [1, [2, 0, 0]]]}, "intensity": 1}]})");
    ASSERT_EQ(scene.lights.size(), 3u);
    const LightSource& key = scene.lights[0];
    EXPECT_EQ(key.kind, LightKind::spot);
    EXPECT_LE(glm::length(key.direction.at(0) - vec3(3, -4, 0)), 1e-6f) << "from position to target";
    EXPECT_FLOAT_EQ(key.inner_cone.at(0), glm::radians(10.0f));
    EXPECT_FLOAT_EQ(key.outer_cone.at(0), glm::radians(20.0f));
    EXPECT_EQ(key.range.at(0), 40);
    EXPECT_EQ(key.volume_scale.at(0), 2);
    EXPECT_EQ(key.surface_scale.at(0), 0.5f);
    EXPECT_EQ(scene.lights[1].kind, LightKind::sun);
    EXPECT_FALSE(scene.lights[1].shadows);
    EXPECT_NEAR(scene.lights[1].angle.at(0), 0.0047124f, 1e-6);
    EXPECT_EQ(scene.lights[1].name, "light 2");
    EXPECT_EQ(scene.lights[2].position.at(0.5), vec3(1, 0, 0));
}

// A light that aims at something while both move keeps pointing at it.
TEST(SceneFile, TargetsAreFollowed) {
    const TempFolder folder;
    for (const char* how : {"linear", "smooth", "step"}) {
        const std::string other = std::string(how) == "linear" ? "smooth" : "linear";
        const Scene scene = loaded(folder, R"({"tyndall": 1, "lights": [{"type": "spot", "intensity": 1,
            "position": {"keys": [[0, [0, 5, 0]], [2, [4, 5, 0]]], "interpolation": ")" +
                                               std::string(how) + R"("},
            "target": {"keys": [[0, [0, 0, 0]], [1, [0, 0, 3]], [3, [6, 0, 0]]], "interpolation": ")" +
                                               other + R"("}}]})");
        Keyed<vec3> target;
        target.times = {0, 1, 3}, target.values = {vec3(0), vec3(0, 0, 3), vec3(6, 0, 0)};
        target.interpolation = other == "smooth" ? Interpolation::smooth : Interpolation::linear;
        const LightSource& light = scene.lights[0];
        for (double t = -0.5; t < 3.5; t += 0.03125) {
            const vec3 aim = target.at(t) - light.position.at(t);
            EXPECT_LE(glm::length(light.direction.at(t) - aim), 0.02f) << how << " at " << t;
        }
    }
}

TEST(SceneFile, ALoopingAimLoops) {
    const TempFolder folder;
    const Scene scene =
        loaded(folder, R"({"tyndall": 1, "lights": [{"type": "spot", "intensity": 1, "position": [0, 5, 0],
        "target": {"keys": [[0, [0, 0, 0]], [1, [4, 0, 0]], [2, [0, 0, 0]]], "interpolation": "smooth", "loop": true}}]})");
    EXPECT_LE(glm::length(scene.lights[0].direction.at(7) - vec3(4, -5, 0)), 1e-5f);
    EXPECT_LE(glm::length(scene.lights[0].direction.at(8.5) - vec3(2, -5, 0)), 1e-5f);
}

TEST(SceneFile, LightsOfTheGltfCanBeChanged) {
    const TempFolder folder;
    GltfBuilder gltf = triangle_gltf();
    gltf.members["extensions"] = R"({"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":5,"color":[1,0,0],
        "spot":{"outerConeAngle":0.5}},{"type":"point","intensity":3}]}})";
    gltf.members["nodes"] = R"([{"name":"lamp","translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}},
        {"name":"bulb","extensions":{"KHR_lights_punctual":{"light":1}}}])";
    gltf.members["scenes"] = R"([{"nodes":[0,1]}])";
    folder.put("room.gltf", gltf.json());
    const Scene scene = loaded(folder, R"({"tyndall": 1, "gltf": "room.gltf", "lights": [
        {"name": "lamp", "intensity": 50, "outer_cone": 60}, {"name": "bulb", "position": [0, 9, 0]},
        {"name": "sun", "type": "sun", "direction": [0, -1, 0], "intensity": 1}]})");
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].intensity.at(0), 50);
    EXPECT_EQ(scene.lights[0].color.at(0), vec3(1, 0, 0)) << "what is not given stays";
    EXPECT_FLOAT_EQ(scene.lights[0].outer_cone.at(0), glm::radians(60.0f));
    EXPECT_GE(scene.lights[0].node, 0);
    EXPECT_EQ(scene.lights[1].node, -1) << "placed by the scene file";
    EXPECT_EQ(scene.lights[1].position.at(0), vec3(0, 9, 0));
    EXPECT_EQ(loaded(folder, R"({"tyndall": 1, "gltf": "room.gltf", "gltf_lights": false})").lights.size(), 0u);
    EXPECT_EQ(scene.inputs.size(), 2u);
}

constexpr const char* recipe = R"({"bounds": {"low": [-1, 0, -1], "high": [1, 2, 1]}, "voxel_size": 0.1,
    "optics": {"extinction": 3, "albedo": [0.9, 0.8, 0.7], "g": 0.4}})";

TEST(SceneFile, Media) {
    const TempFolder folder;
    folder.put("dust.json", recipe);
    const Scene scene = loaded(folder, R"({"tyndall": 1, "media": [
        {"type": "homogeneous", "extinction": {"keys": [[0, 1], [1, 3]]}, "albedo": 0.5, "bounds": {"low": [-1, -1, -1], "high": [1, 1, 1]},
         "translate": [0, 1, 0], "rotate": [0, 90, 0], "scale": 2, "emission": [0, 1, 0]},
        {"name": "ground", "type": "height", "extinction": 0.1, "falloff": 4, "base": 1, "phase": "rayleigh"},
        {"type": "noise", "recipe": "dust.json", "voxel_size": 0.05, "wind": [0, 0, -0.5]},
        {"type": "noise", "recipe": "dust.json", "extinction": 9, "albedo": [1, 1, 0.5], "g": -0.2, "phase": "schlick"}]})");
    ASSERT_EQ(scene.media.size(), 4u);
    const MediumSource& box = scene.media[0];
    EXPECT_EQ(box.extinction.at(0.5), 2);
    EXPECT_EQ(box.albedo.at(0), vec3(0.5f));
    EXPECT_EQ(box.scale.at(0), vec3(2));
    EXPECT_EQ(box.emission.at(0), vec3(0, 1, 0));
    EXPECT_LE(glm::length(box.rotation.at(0) * vec3(0, 0, 1) - vec3(1, 0, 0)), 1e-6f);
    EXPECT_EQ(box.bounds.low, vec3(-1));
    EXPECT_EQ(scene.media[1].phase.kind, PhaseKind::rayleigh);
    EXPECT_EQ(scene.media[1].height_falloff.at(0), 4);
    EXPECT_FALSE(is_finite(scene.media[1].bounds.low)) << "everywhere";
    EXPECT_EQ(scene.media[2].extinction.at(0), 3) << "from the recipe";
    EXPECT_EQ(scene.media[2].albedo.at(0), vec3(0.9f, 0.8f, 0.7f));
    EXPECT_FLOAT_EQ(scene.media[2].g.at(0), 0.4f);
    EXPECT_FLOAT_EQ(scene.media[2].voxel_size, 0.05f);
    EXPECT_EQ(scene.media[2].recipe->wind, vec3(0, 0, -0.5f)) << "instead of the recipe's";
    EXPECT_EQ(scene.media[3].extinction.at(0), 9) << "from the scene";
    EXPECT_FLOAT_EQ(scene.media[3].g.at(0), -0.2f);
    EXPECT_EQ(scene.inputs.size(), 2u);
}

// About X first, then Y, then Z, and turns over half a circle go all the way.
TEST(SceneFile, RotationOfMedia) {
    const TempFolder folder;
    const Scene scene = loaded(folder, R"({"tyndall": 1, "media": [
        {"type": "homogeneous", "extinction": 1, "rotate": [90, 90, 0]},
        {"type": "homogeneous", "extinction": 1, "rotate": {"keys": [[0, [0, 0, 0]], [1, [0, 720, 0]]]}}]})");
    EXPECT_LE(glm::length(scene.media[0].rotation.at(0) * vec3(0, 1, 0) - vec3(1, 0, 0)), 1e-6f);
    for (const float share : {0.1f, 0.25f, 0.6f, 0.99f}) {
        const quat expected = glm::angleAxis(share * 4 * pi, vec3(0, 1, 0));
        EXPECT_NEAR(std::abs(glm::dot(scene.media[1].rotation.at(share), expected)), 1, 1e-5) << share;
    }
}

TEST(SceneFile, VolumesBringTheirOptics) {
    const TempFolder folder;
    SparseVolume volume;
    volume.leaves.resize(1);
    volume.leaves[0].values.fill(1);
    volume.active_low = ivec3(0), volume.active_high = ivec3(7);
    write_vdb(folder / "bare.vdb", volume);
    volume.metadata = {{"tyndall_extinction_per_m", "2.5"}, {"tyndall_albedo", "0.5 0.6 0.7"}, {"tyndall_g", "0.25"}};
    for (const char* name : {"fog.0002.vdb", "fog.0003.vdb"}) write_vdb(folder / name, volume);

    const Scene scene = loaded(folder, R"({"tyndall": 1, "media": [
        {"type": "vdb", "file": "fog.####.vdb", "sequence": {"mode": "ping_pong", "offset": -3}},
        {"type": "vdb", "file": "fog.0002.vdb", "g": 0.1, "grid": "density", "up_axis": "Z"}, {"type": "vdb", "file": "bare.vdb"}]})");
    EXPECT_EQ(scene.media[0].extinction.at(0), 2.5f);
    EXPECT_EQ(scene.media[0].albedo.at(0), vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(scene.media[0].g.at(0), 0.25f);
    EXPECT_EQ(scene.media[0].sequence.mode, SequenceMode::ping_pong);
    EXPECT_EQ(scene.media[0].sequence.offset, -3);
    EXPECT_EQ(scene.media[0].sequence.files, (std::vector<int>{2, 3}));
    EXPECT_EQ(scene.media[1].g.at(0), 0.1f);
    EXPECT_EQ(scene.media[1].density_grid, "density");
    EXPECT_TRUE(scene.media[1].z_up && !scene.media[0].z_up);
    EXPECT_TRUE(has_warning(scene, "/media/2/file"));
    EXPECT_FALSE(has_warning(scene, "/media/0"));
}

TEST(SceneFile, Backgrounds) {
    const TempFolder folder;
    folder.put("plate.png", png_of({1, 1}, {{255, 0, 0, 255}}));
    const Scene plate = loaded(folder, R"({"tyndall": 1, "background": {"image": "plate.png", "intensity": 2}})");
    ASSERT_EQ(plate.background.kind, BackgroundKind::image);
    EXPECT_EQ(plate.background.image->at(0, 0), vec3(1, 0, 0));
    EXPECT_FALSE(plate.background.lat_long);
    EXPECT_EQ(plate.inputs.size(), 2u);
    folder.put("sky.hdr", radiance_of({2, 1}, {{128, 64, 0, 132}, {0, 0, 0, 0}}));
    const Scene dome = loaded(
        folder, R"({"tyndall": 1, "background": {"image": "sky.hdr", "projection": "lat_long", "rotation": 90}})");
    EXPECT_TRUE(dome.background.lat_long);
    EXPECT_FLOAT_EQ(dome.background.rotation.at(0), pi / 2);
    EXPECT_EQ(dome.background.image->at(0, 0), vec3(8, 4, 0));
    const Scene sky = loaded(folder, R"({"tyndall": 1, "background": {"sky": {"zenith": [0, 0, 1], "horizon": 0.5}}})");
    EXPECT_EQ(sky.background.kind, BackgroundKind::sky);
    EXPECT_EQ(sky.background.ground.at(0), vec3(0.5f)) << "the horizon's, when not given";
}

// What other programs animate, too: a sky that turns, a light that dies away, an orthographic zoom.
TEST(SceneFile, MapsRangesAndHeightsOfViewsHaveKeys) {
    const TempFolder folder;
    folder.put("sky.hdr", radiance_of({2, 1}, {{128, 64, 0, 132}, {0, 0, 0, 0}}));
    const Scene scene = loaded(folder, R"({"tyndall": 1,
        "camera": {"position": [0, 0, 5], "target": [0, 0, 0], "ortho_height": {"keys": [[0, 4], [1, 2]]}},
        "lights": [{"type": "environment", "image": "sky.hdr", "rotation": {"keys": [[0, 0], [1, 180]]}},
                   {"type": "point", "position": [0, 1, 0], "intensity": 1, "range": {"keys": [[0, 2], [1, 4]]}}]})");
    EXPECT_FLOAT_EQ(scene.cameras[0].ortho_height.at(0.5), 3);
    EXPECT_FLOAT_EQ(scene.environment->map.rotation.at(0.5), pi / 2);
    EXPECT_FLOAT_EQ(scene.background.rotation.at(0.5), pi / 2) << "the camera sees it turn, too";
    EXPECT_FLOAT_EQ(scene.lights[0].range.at(0.5), 3);
}

TEST(SceneFile, Billboards) {
    const TempFolder folder;
    const Scene scene = loaded(folder, R"({"tyndall": 1,
        "lights": [{"name": "sun", "type": "sun", "direction": [0, -1, 0], "intensity": 1}],
        "billboards": [{"light": "sun", "from": [0, 3, 0], "to": [1, 0, 0], "width_to": 2, "tint": 0.5, "intensity": 3}]})");
    ASSERT_EQ(scene.billboards.size(), 1u);
    EXPECT_EQ(scene.billboards[0].to, vec3(1, 0, 0));
    EXPECT_EQ(scene.billboards[0].tint, vec3(0.5f));
    EXPECT_EQ(scene.billboards[0].width_to, 2);
}

TEST(SceneFile, ScenesOfTheRepositoryLoad) {
    const std::filesystem::path folder = TYNDALL_SOURCE_DIR "/scenes";
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
        const LoadResult answer = load(entry.path());
        // Some read volumes that a bake has yet to make.
        if (answer.code == ExitCode::unreadable) continue;
        EXPECT_TRUE(answer.loaded) << answer.message;
        EXPECT_TRUE(answer.scene.warnings.empty()) << answer.scene.warnings.front();
        ++count;
    }
    EXPECT_GE(count, 4);
}
}
}

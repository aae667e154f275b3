
#include "base/error.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/meshes.h"
#include "support/scratch.h"
#include "trace/fog/media.h"
#include "trace/lights/environment.h"
#include "trace/snapshot.h"
#include "volume/bricks/bricks.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/fog_fixtures.h"
#include "volume/medium.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

MediumSource noise_source() {
    MediumSource source;
    source.name = "mist";
    source.kind = MediumKind::noise;
    FogRecipe recipe;
    recipe.voxel_size = 0.1f;
    recipe.threshold = 0.4f;
    source.recipe = recipe;
    return source;
}

MediumSource file_source(const std::filesystem::path& file) {
    MediumSource source;
    source.name = "cloud";
    source.kind = MediumKind::vdb;
    source.sequence.pattern = file.string();
    return source;
}

TEST(Snapshot, MapsTurnAndRangesGrow) {
    Scene scene;
    scene.background.stated = true, scene.background.rotation = from_to(0.0f, 2.0f);
    LightSource lamp;
    lamp.intensity = 10.0f, lamp.range = from_to(2.0f, 4.0f);
    scene.lights = {lamp};
    const Snapshot now = make_snapshot(scene, Moment{12, 0.5});
    EXPECT_EQ(now.background.rotation, 1);
    EXPECT_EQ(now.lights.at(0).range, 3);
}

TEST(Snapshot, ScaleZeroHidesLights) {
    Scene scene;
    Node parent, node;
    parent.scale = from_to(vec3(0), vec3(1)), node.parent = 0;
    scene.nodes = {parent, node};
    LightSource lamp;
    lamp.name = "lamp", lamp.kind = LightKind::spot, lamp.node = 1, lamp.intensity = 10.0f;
    scene.lights = {lamp};
    EXPECT_TRUE(make_snapshot(scene, Moment{0, 0}).lights.empty());
    EXPECT_EQ(make_snapshot(scene, Moment{12, 0.5}).lights.size(), 1u);
    scene.nodes[1].scale = vec3(1, 1, 0); // flattened along its direction
    EXPECT_TRUE(make_snapshot(scene, Moment{12, 0.5}).lights.empty());
    scene.nodes[1].scale = vec3(0, 1, 1);
    EXPECT_EQ(make_snapshot(scene, Moment{12, 0.5}).lights.size(), 1u);
    scene.nodes[1].scale = vec3(1, 1, std::numeric_limits<float>::quiet_NaN());
    EXPECT_THROW(make_snapshot(scene, Moment{12, 0.5}), Error);
    scene.nodes[1].scale = vec3(0), scene.nodes[1].translation = vec3(std::numeric_limits<float>::infinity());
    EXPECT_THROW(make_snapshot(scene, Moment{12, 0.5}), Error);
}

TEST(Snapshot, EvaluatesLightsAndDropsDarkOnes) {
    Scene scene;
    Node node;
    node.translation = vec3(1, 2, 3);
    node.rotation = glm::angleAxis(pi / 2, vec3(0, 1, 0)); // -z turns to -x
    node.scale = vec3(3);
    scene.nodes = {node};
    LightSource lamp;
    lamp.name = "lamp", lamp.kind = LightKind::spot, lamp.node = 0;
    lamp.intensity = from_to(0.0f, 10.0f);
    lamp.color = vec3(1, 0.5f, 0);
    lamp.inner_cone = 1.0f, lamp.outer_cone = 0.5f;
    LightSource dark;
    dark.intensity = 0.0f;
    scene.lights = {lamp, dark};

    EXPECT_TRUE(make_snapshot(scene, Moment{0, 0}).lights.empty());
    const Snapshot snapshot = make_snapshot(scene, Moment{12, 0.5});
    EXPECT_EQ(snapshot.frame, 12);
    ASSERT_EQ(snapshot.lights.size(), 1u);
    const Light& light = snapshot.lights[0];
    EXPECT_EQ(light.position, vec3(1, 2, 3));
    EXPECT_NEAR(glm::distance(light.direction, vec3(-1, 0, 0)), 0, 1e-6);
    EXPECT_EQ(light.intensity, vec3(5, 2.5f, 0));
    EXPECT_EQ(light.inner_cone, 0.5f);
    EXPECT_EQ(snapshot.bounds.low, vec3(1, 2, 3));
}

// Dark but for a millisecond of the exposure's second, between two of its four moments.
template<class T> Keyed<T> flash(T value) {
    Keyed<T> keys;
    keys.times = {0, 0.301f, 0.302f}, keys.values = {0.0f * value, value, 0.0f * value};
    keys.interpolation = Interpolation::step;
    return keys;
}

TEST(Snapshot, MomentsShareAllOfAFlash) {
    Scene scene;
    scene.frame_rate = 1;
    scene.lights.resize(3);
    scene.lights[0].name = "flash", scene.lights[0].intensity = flash(1000.0f);
    scene.lights[1].name = "on fog", scene.lights[1].volume_scale = flash(1000.0f);
    scene.lights[2].name = "stops", scene.lights[2].exposure = from_to(0.0f, 10.0f);
    scene.ambient = flash(vec3(1000)), scene.background.color = flash(vec3(1000));
    scene.environment.emplace().intensity = flash(1000.0f), scene.environment->map.color = vec3(1);
    MediumSource& glow = scene.media.emplace_back();
    glow.extinction = 0.1f, glow.bounds = {vec3(-1), vec3(1)}, glow.emission = flash(vec3(1000));
    const Snapshot middle = make_snapshot(scene, frame_moments(scene, 0, {0, 1, {}}, 4));
    ASSERT_EQ(middle.moments->size(), 4u);

    float flashed = 0, on_fog = 0, stops = 0, ambient = 0, background = 0, environment = 0, emission = 0;
    for (const Snapshot& moment : *middle.moments) {
        for (const Light& light : moment.lights) {
            if (light.name == "flash") flashed += light.intensity.x / 4;
            if (light.name == "on fog") on_fog += light.intensity.x * light.volume_scale / 4;
            if (light.name == "stops") stops += light.intensity.x / 4;
        }
        ambient += moment.ambient.x / 4, background += moment.background.color.x * moment.background.intensity / 4;
        if (moment.environment) environment += moment.environment->scale.x / 4;
        emission += moment.media[0].optics.emission.radiance.x / 4;
    }
    for (const float mean : {flashed, on_fog, ambient, background, environment, emission}) EXPECT_NEAR(mean, 1, 1e-3f);
    EXPECT_NEAR(stops, 1023 / (10 * std::numbers::ln2), 0.01f); // of 2^(10 t) over 0..1
    ASSERT_EQ(middle.lights.size(), 3u);
    EXPECT_NEAR(middle.lights[0].intensity.x, 1, 1e-3f) << "the middle stands for all of them";
    EXPECT_EQ(make_snapshot(scene, frame_moments(scene, 0, {0, 0.3, {}}, 4)).lights.size(), 2u) << "before it";
}

TEST(Snapshot, ScalesAreAveragedWithTheLightTheyScale) {
    // 10 t times 1 - t over 0..1: 10/6.
    Scene scene;
    scene.frame_rate = 1;
    EnvironmentSource& sky = scene.environment.emplace();
    sky.map.color = vec3(1), sky.intensity = from_to(0.0f, 10.0f);
    sky.volume_scale = sky.surface_scale = from_to(1.0f, 0.0f);
    LightSource& lamp = scene.lights.emplace_back();
    lamp.intensity = sky.intensity, lamp.volume_scale = lamp.surface_scale = sky.volume_scale;
    const Snapshot middle = make_snapshot(scene, frame_moments(scene, 0, {0, 1, {}}, 1).middle);
    const Environment& environment = *middle.environment;
    const Light& light = middle.lights[0];
    for (const auto& [intensity, scale] : {std::pair{environment.scale.x, environment.volume_scale},
                                           {environment.scale.x, environment.surface_scale},
                                           {light.intensity.x, light.volume_scale},
                                           {light.intensity.x, light.surface_scale}})
        EXPECT_NEAR(intensity * scale, 10.0f / 6, 0.01f);
}

TEST(Snapshot, ExtentIgnoresStandInsForSunsAndFarTargets) {
    Scene scene;
    add_mesh(scene, quad(vec3(0), {4, 0, 0}, {0, 0, 3}));
    scene.cameras.emplace_back().position = vec3(0, 0, 3), scene.cameras[0].target = vec3(0);
    const float extent = make_snapshot(scene, Moment{0, 0}).extent;
    EXPECT_NEAR(extent, 5, 0.1f);
    scene.cameras[0].target = vec3(0, 0, -1e6f);
    scene.lights.emplace_back().position = vec3(1e6f);
    EXPECT_EQ(make_snapshot(scene, Moment{0, 0}).extent, extent);
    scene.instances.clear();
    EXPECT_GT(make_snapshot(scene, Moment{0, 0}).extent, 1e6f) << "a lamp alone";
}

TEST(Snapshot, LightWithoutDirectionIsRefused) {
    Scene scene;
    scene.file = "room.json";
    LightSource light;
    light.name = "sun", light.kind = LightKind::sun;
    light.direction = vec3(0);
    scene.lights = {light};
    EXPECT_THAT([&] { make_snapshot(scene, Moment{}); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("light sun")));
}

TEST(Snapshot, AnalyticMediaMoveWithTheirTransform) {
    Scene scene;
    MediumSource box;
    box.extinction = from_to(0.0f, 1.0f);
    box.bounds = {vec3(-1), vec3(1)};
    box.translation = vec3(5, 0, 0);
    box.scale = vec3(2, 1, 1);
    MediumSource layer;
    layer.kind = MediumKind::height;
    layer.bounds = {vec3(-infinity, 0, -infinity), vec3(infinity, 3, infinity)};
    layer.translation = vec3(0, 1, 0);
    layer.height_base = from_to(0.0f, 2.0f);
    scene.media = {box, layer};

    EXPECT_EQ(make_snapshot(scene, Moment{0, 0}).media.size(), 1u); // the box has no extinction yet
    const Snapshot snapshot = make_snapshot(scene, Moment{0, 1});
    ASSERT_EQ(snapshot.media.size(), 2u);
    EXPECT_EQ(snapshot.media[0].world_bounds.low, vec3(3, -1, -1));
    EXPECT_EQ(snapshot.media[0].world_bounds.high, vec3(7, 1, 1));
    EXPECT_EQ(snapshot.media[1].world_bounds.low, vec3(-infinity, 1, -infinity));
    EXPECT_EQ(snapshot.media[1].world_bounds.high, vec3(infinity, 4, infinity));
    EXPECT_EQ(snapshot.media[1].density.height_base, 2);
    EXPECT_EQ(snapshot.bounds.low, vec3(3, -1, -1));
    EXPECT_EQ(snapshot.bounds.high, vec3(7, 1, 1));
    EXPECT_NEAR(optical_depth(snapshot.media[0], {vec3(0), vec3(1, 0, 0)}), 4, 1e-5);
}

TEST(Snapshot, MovedBoxesCoverTheirCorners) {
    const mat4 matrix = glm::rotate(glm::translate(mat4(1), vec3(1, 2, 3)), 0.5f, glm::normalize(vec3(1, 1, 0)));
    const Box box = transform_box(matrix, {vec3(-1, -2, -3), vec3(3, 2, 1)});
    const Box expected = transform(matrix, {vec3(-1, -2, -3), vec3(3, 2, 1)});
    EXPECT_NEAR(glm::distance(box.low, expected.low), 0, 1e-5);
    EXPECT_NEAR(glm::distance(box.high, expected.high), 0, 1e-5);
}

TEST(Snapshot, FlatMediumIsRefused) {
    Scene scene;
    MediumSource source;
    source.name = "sheet";
    source.scale = vec3(1, 0, 1);
    scene.media = {source};
    EXPECT_THAT([&] { make_snapshot(scene, Moment{}); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("medium sheet")));
}

TEST(Snapshot, StillFogIsGrownOnceAndDriftingFogAnew) {
    Scene scene;
    scene.media = {noise_source(), noise_source()};
    scene.media[1].recipe->wind = vec3(1, 0, 0);
    const Snapshot first = make_snapshot(scene, Moment{0, 0});
    ASSERT_EQ(first.media.size(), 2u);
    const Snapshot next = make_snapshot(scene, Moment{1, 0.5}, &first);
    EXPECT_EQ(next.media[0].density.bricks, first.media[0].density.bricks);
    EXPECT_NE(next.media[1].density.bricks, first.media[1].density.bricks);
    EXPECT_EQ(make_snapshot(scene, Moment{1, 0.5}, &next).media[1].density.bricks, next.media[1].density.bricks);
}

// What a frame holds must not depend on the frame before.
TEST(Snapshot, ReuseGivesTheSameBits) {
    Scene scene;
    scene.media = {noise_source()};
    scene.media[0].translation = from_to(vec3(0), vec3(3, 1, 2));
    scene.media[0].rotation = from_to(quat(1, 0, 0, 0), glm::angleAxis(1.0f, vec3(0, 1, 0)));
    const Snapshot first = make_snapshot(scene, Moment{0, 0.1});
    const Snapshot second = make_snapshot(scene, Moment{1, 0.2}, &first);
    const Snapshot third = make_snapshot(scene, Moment{2, 0.3}, &second);
    const Snapshot fresh = make_snapshot(scene, Moment{2, 0.3});
    const BrickPool &a = *third.media[0].density.bricks, &b = *fresh.media[0].density.bricks;
    EXPECT_EQ(a.index_to_world, b.index_to_world);
    EXPECT_EQ(a.world_to_index, b.world_to_index);
    EXPECT_EQ(a.bounds.low, b.bounds.low);
    EXPECT_EQ(a.anchor, b.anchor);
    EXPECT_EQ(a.values, b.values);
    EXPECT_EQ(third.fog_sources[0].bricks, first.fog_sources[0].bricks);
    EXPECT_EQ(make_snapshot(scene, Moment{2, 0.3}, &third).media[0].density.bricks, third.media[0].density.bricks);
    EXPECT_EQ(third.media[0].world_bounds.low, b.bounds.low);
}

TEST(Snapshot, FilesAreReadOnceAndAgainWhenTheyChange) {
    const TempFolder scratch;
    const auto file = scratch / "fog.vdb";
    SparseVolume volume = constant_box(16, 0.5f);
    volume.index_to_world = glm::translate(dmat4(1), dvec3(4, 0, 0));
    write_vdb(file, volume);
    Scene scene;
    scene.media = {file_source(file)};
    scene.media[0].translation = vec3(0, 10, 0);
    const Snapshot first = make_snapshot(scene, Moment{1, 0});
    ASSERT_EQ(first.media.size(), 1u);
    EXPECT_NEAR(first.media[0].world_bounds.center().x, 11.5f, 1e-3);
    EXPECT_NEAR(first.media[0].world_bounds.center().y, 17.5f, 1e-3);
    const Snapshot same = make_snapshot(scene, Moment{2, 1}, &first);
    EXPECT_EQ(same.media[0].density.bricks, first.media[0].density.bricks);

    write_vdb(file, constant_box(24, 0.5f));
    const Snapshot changed = make_snapshot(scene, Moment{3, 2}, &same);
    EXPECT_NE(changed.media[0].density.bricks, first.media[0].density.bricks);
    EXPECT_NEAR(changed.media[0].density.bricks->mass, 0.5 * 24 * 24 * 24, 1);
}

// A column along z, thinner upwards and lit towards +y, must stand on the ground and be lit towards -z.
TEST(Snapshot, VolumesWithZUpStandUpright) {
    const TempFolder scratch;
    const auto file = scratch / "column.vdb";
    SparseVolume volume = constant_box(16, 1);
    for (Leaf& leaf : volume.leaves)
        for (int v = 0; v < 512; ++v) {
            const ivec3 at = leaf.origin + ivec3(v >> 6, v >> 3 & 7, v & 7);
            leaf.values[static_cast<size_t>(v)] = (at.z < 8 ? 1.0f : 0.5f) * (at.y < 8 ? 0.5f : 1.0f);
        }
    write_vdb(file, volume);
    Scene scene;
    scene.media = {file_source(file)};
    scene.media[0].z_up = true;
    scene.media[0].scale = vec3(2), scene.media[0].translation = vec3(100, 0, 0);
    const Snapshot snapshot = make_snapshot(scene, Moment{});
    const Medium& column = snapshot.media.at(0);
    expect_near(column.world_bounds.low, vec3(98, -2, -32), 1e-3f);
    expect_near(column.world_bounds.high, vec3(132, 32, 2), 1e-3f);
    EXPECT_EQ(density_at(column, {115, 4, -24}), 1);
    EXPECT_EQ(density_at(column, {115, 4, -4}), 0.5f);
    EXPECT_EQ(density_at(column, {115, 24, -24}), 0.5f);
    EXPECT_EQ(density_at(column, {115, 24, -4}), 0.25f);
}

TEST(Snapshot, ClippedSequencesHaveNoFog) {
    const TempFolder scratch;
    write_vdb(scratch / "fog.0002.vdb", constant_box(16, 0.5f));
    Scene scene;
    scene.media = {file_source(scratch / "fog.####.vdb")};
    scene.media[0].sequence.files = {2};
    scene.media[0].sequence.mode = SequenceMode::clip;
    EXPECT_TRUE(make_snapshot(scene, Moment{1, 0}).media.empty());
    EXPECT_EQ(make_snapshot(scene, Moment{2, 0}).media.size(), 1u);
    scene.media[0].sequence.mode = SequenceMode::hold;
    EXPECT_EQ(make_snapshot(scene, Moment{1, 0}).media.size(), 1u);
}

TEST(Snapshot, MissingFileIsNamed) {
    Scene scene;
    scene.media = {file_source("/nowhere/fog.vdb")};
    EXPECT_THAT([&] { make_snapshot(scene, Moment{}); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("/nowhere/fog.vdb")));
}

TEST(Snapshot, DroppedTrianglesAreSaidOnce) {
    Scene scene;
    add_mesh(scene, quad(vec3(0), vec3(1, 0, 0), vec3(2, 0, 0)));
    const Snapshot first = make_snapshot(scene, Moment{0, 0});
    EXPECT_THAT(first.notes, testing::ElementsAre(testing::HasSubstr("2 triangles")));
    EXPECT_TRUE(make_snapshot(scene, Moment{1, 1}, &first).notes.empty());
}

TEST(Snapshot, CamerasFromNodesAreOrthonormal) {
    Scene scene;
    Node node;
    node.translation = vec3(1, 2, 3);
    node.rotation = glm::angleAxis(0.4f, glm::normalize(vec3(1, 2, 0)));
    node.scale = vec3(-2, 3, 0.5f); // mirrored: the camera is not
    scene.nodes = {node};
    CameraSource source;
    source.name = "shot", source.node = 0;
    source.vertical_fov = from_to(0.5f, 1.0f);
    source.near = 0.2f, source.far = 90;
    scene.cameras = {source};
    const Camera camera = camera_at(scene, 0, 0.5);
    EXPECT_EQ(camera.position, vec3(1, 2, 3));
    EXPECT_NEAR(camera.vertical_fov, 0.75f, 1e-6);
    EXPECT_EQ(camera.near, 0.2f);
    EXPECT_EQ(camera.far, 90);
    EXPECT_NEAR(glm::length(camera.right), 1, 1e-6);
    EXPECT_NEAR(dot(camera.right, camera.up), 0, 1e-6);
    EXPECT_NEAR(glm::distance(glm::cross(camera.right, camera.up), -camera.forward), 0, 1e-6);
    const mat3 turned = glm::mat3_cast(node.rotation.values[0]);
    EXPECT_NEAR(glm::distance(camera.forward, -turned[2]), 0, 1e-6);
}

TEST(Snapshot, CamerasAreFoundByName) {
    Scene scene;
    CameraSource a, b;
    a.name = "wide", b.name = "close";
    b.position = vec3(0, 5, 0), b.target = vec3(0, 5, -1);
    scene.cameras = {a, b};
    scene.camera = 1;
    EXPECT_EQ(find_camera(scene, ""), 1);
    EXPECT_EQ(find_camera(scene, "wide"), 0);
    EXPECT_THAT([&] { find_camera(scene, "wid"); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("did you mean wide?")));
    EXPECT_NEAR(camera_at(scene, 1, 0).forward.z, -1, 1e-6);
    scene.cameras[0].target = scene.cameras[0].position;
    EXPECT_THROW(camera_at(scene, 0, 0), Error);
}
}
}

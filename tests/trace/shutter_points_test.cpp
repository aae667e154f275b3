// What counts as motion across the image: shadows, images of lights, and fog that the camera sees move.
#include "scene/lights/gobo.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/scratch.h"
#include "trace/shutter_motion.h"
#include "trace/shutter_shadows.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/fog_fixtures.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr int side = 100; // pixels of an image 4 m high and wide, seen along -z
const Shutter second{0, 1, {}};

Scene seen_from_the_front() {
    Scene scene;
    scene.frame_rate = 1;
    CameraSource camera;
    camera.ortho_height = 4, camera.position = vec3(0, 0, 5), camera.shutter = second;
    scene.cameras.push_back(camera);
    MediumSource fog;
    fog.bounds = {vec3(-2), vec3(2)};
    scene.media.push_back(fog);
    return scene;
}

// Meters.
float motion(const Scene& scene) { return image_motion(scene, 0, ivec2(side), 0, second) * 4 / side; }

void add_lamp(Scene& scene, vec3 first, vec3 last) {
    LightSource lamp;
    lamp.position = from_to(first, last);
    scene.lights.push_back(lamp);
}

// A small triangle 0.1 m below the lamps.
Mesh speck() {
    Mesh mesh;
    mesh.positions = {{0, 0.9f, 0}, {0.01f, 0.9f, 0}, {0, 0.9f, 0.01f}}, mesh.triangles = {{0, 1, 2}};
    return mesh;
}

// A lamp that moves 0.1 m throws the shadow of what is 0.1 m below it as far at twice the distance.
TEST(ShutterPoints, ShadowsMoveFasterThanTheirLamp) {
    Scene scene = seen_from_the_front();
    add_lamp(scene, {-0.05f, 1, 0}, {0.05f, 1, 0});
    EXPECT_NEAR(motion(scene), 0.1f, 1e-3f);
    add_mesh(scene, speck());
    EXPECT_GT(motion(scene), 1.9f) << "at the lower edge of the image";
    EXPECT_LT(motion(scene), 4.0f);
    scene.instances[0].casts_shadows = false;
    EXPECT_NEAR(motion(scene), 0.1f, 1e-3f);
    scene.instances[0].casts_shadows = true, scene.lights[0].range = 0.2f;
    EXPECT_NEAR(motion(scene), 0.1f, 0.01f) << "no light gets farther";
}

TEST(ShutterPoints, ShadowsOfWhatMovesAreCarriedAlong) {
    Scene scene = seen_from_the_front();
    add_lamp(scene, {0, 1, 0}, {0, 1, 0});
    Node node;
    node.translation = from_to(vec3(-0.05f, 0, 0), vec3(0.05f, 0, 0));
    add_mesh(scene, speck(), node);
    EXPECT_GT(motion(scene), 1.9f);
    scene.lights[0].kind = LightKind::spot, scene.lights[0].direction = vec3(0, 1, 0);
    EXPECT_NEAR(motion(scene), 0.1f, 1e-3f) << "the spot shines the other way";
}

TEST(ShutterPoints, ManyLightsAndMeshesAreSampled) {
    Scene scene = seen_from_the_front();
    for (int i = 0; i < 30; ++i) add_lamp(scene, {-0.05f, 1, 0}, {0.05f, 1, 0});
    for (int i = 0; i < 2000; ++i) add_mesh(scene, speck());
    const std::vector<ShadowRay> rays = shadow_rays(scene, 0.5, 7);
    EXPECT_GT(rays.size(), 1000u);
    EXPECT_LE(rays.size(), 2048u);
}

LightSource spot_down() {
    LightSource spot;
    spot.kind = LightKind::spot, spot.position = vec3(0, 1, 0), spot.direction = vec3(0, -1, 0);
    spot.range = 2, spot.outer_cone = pi / 4;
    return spot;
}

// At 2 m along the edge of a cone of 45 degrees, 1.41 m from the axis, a quarter turn moves the image by up to that
// times √2.
TEST(ShutterPoints, ImagesTurnWithTheirGobo) {
    Scene scene = seen_from_the_front();
    LightSource spot = spot_down();
    spot.gobo = GoboSource{};
    spot.gobo->rotation = from_to(0.0f, pi / 2);
    scene.lights = {spot};
    EXPECT_NEAR(motion(scene), 2.0f, 0.1f);
    spot.gobo->rotation = 0.0f, spot.gobo->scale = from_to(1.0f, 0.5f);
    scene.lights = {spot};
    EXPECT_NEAR(motion(scene), 2 * (pi / 4 - std::atan(0.5f)), 0.01f) << "along an arc";
}

TEST(ShutterPoints, APlainBeamLooksTheSameAroundItsAxis) {
    Scene scene = seen_from_the_front();
    LightSource spot = spot_down();
    spot.up = from_to(vec3(0, 0, 1), vec3(1, 0, 0));
    scene.lights = {spot};
    EXPECT_NEAR(motion(scene), 0, 1e-3f);
    spot.outer_cone = from_to(0.0f, pi / 4);
    scene.lights = {spot};
    EXPECT_NEAR(motion(scene), pi / 2, 0.01f) << "and opens";
}

TEST(ShutterPoints, AreaLightsGrow) {
    Scene scene = seen_from_the_front();
    LightSource face;
    face.kind = LightKind::rectangle, face.direction = vec3(0, 0, 1), face.width = from_to(1.0f, 2.0f);
    scene.lights = {face};
    EXPECT_NEAR(motion(scene), 0.5f, 1e-3f);
}

// 16 voxels of 0.1 m from the origin on, turned by a quarter about the origin: the farthest corner moves √2 times its
// distance.
TEST(ShutterPoints, VolumesOfFilesTurn) {
    const TempFolder folder;
    SparseVolume volume = constant_box(16, 1);
    volume.index_to_world = glm::scale(dmat4(1), dvec3(0.1));
    write_vdb(folder / "fog.vdb", volume);
    Scene scene = seen_from_the_front();
    MediumSource& fog = scene.media[0];
    fog.kind = MediumKind::vdb, fog.sequence.pattern = folder.file("fog.vdb");
    EXPECT_NEAR(motion(scene), 0, 1e-3f);
    fog.rotation = from_to(quat(1, 0, 0, 0), glm::angleAxis(pi / 2, vec3(0, 0, 1)));
    EXPECT_NEAR(motion(scene), 1.6f * pi / 2 * std::sqrt(2.0f), 0.2f);
    fog.sequence.pattern = folder.file("missing.vdb");
    EXPECT_NEAR(motion(scene), 0, 1e-3f) << "is refused when it is read";
}

TEST(ShutterPoints, FogRises) {
    Scene scene = seen_from_the_front();
    MediumSource& fog = scene.media[0];
    fog.kind = MediumKind::height, fog.height_base = from_to(-0.5f, 0.5f);
    EXPECT_NEAR(motion(scene), 1, 1e-3f);
    fog.height_base = 0.0f, fog.height_falloff = from_to(0.5f, 0.2f);
    EXPECT_NEAR(motion(scene), 0.3f, 1e-3f);
}

TEST(ShutterPoints, NoiseDriftsWithItsWind) {
    Scene scene = seen_from_the_front();
    MediumSource& fog = scene.media[0];
    fog.kind = MediumKind::noise, fog.recipe = FogRecipe{};
    fog.recipe->noise.evolve = 2;
    EXPECT_NEAR(motion(scene), 0, 1e-3f) << "changes in place";
    fog.recipe->wind = vec3(0, 0, 3);
    EXPECT_NEAR(motion(scene), 0, 1e-3f) << "towards the camera";
    fog.recipe->wind = vec3(0.5f, 0, 0);
    EXPECT_NEAR(motion(scene), 0.5f, 1e-3f);
    fog.rotation = glm::angleAxis(pi / 2, vec3(0, 1, 0));
    EXPECT_NEAR(motion(scene), 0, 1e-3f) << "turned towards the camera";
    fog.recipe->fire = FireRecipe{};
    fog.recipe->fire->rise = 0.7f;
    EXPECT_NEAR(motion(scene), 0.7f, 1e-3f) << "flames rise";
}

// Nothing of the fog's bounds is in view; the wind is that of the fog between.
TEST(ShutterPoints, WindIsFeltFromWithin) {
    Scene scene = seen_from_the_front();
    MediumSource& fog = scene.media[0];
    fog.kind = MediumKind::noise, fog.recipe = FogRecipe{};
    fog.recipe->bounds = {vec3(-50), vec3(50)}, fog.recipe->wind = vec3(0.5f, 0, 0);
    EXPECT_NEAR(motion(scene), 0.5f, 1e-3f);
}

// The corners of the only mesh are far beyond the edges of the image.
TEST(ShutterPoints, ACameraPassesWhatItIsAmong) {
    Scene scene = seen_from_the_front();
    scene.media[0].bounds = {vec3(-50, -50, -2), vec3(50, 50, 2)};
    CameraSource& camera = scene.cameras[0];
    camera.position = from_to(vec3(-0.3f, 0, 5), vec3(0.3f, 0, 5)),
    camera.target = from_to(vec3(-0.3f, 0, 0), vec3(0.3f, 0, 0));
    EXPECT_NEAR(motion(scene), 0.6f, 1e-3f);
}

// In a square image of 90 degrees, what a corner of one of 71.6 degrees shows is at 0.72 of the way to the corner;
// at 53.1 degrees it is at 1.44.
TEST(ShutterPoints, ACameraZoomsIntoWhatItIsAmong) {
    Scene scene = seen_from_the_front();
    scene.media[0].bounds = {vec3(-50, -50, -2), vec3(50, 50, 2)};
    CameraSource& camera = scene.cameras[0];
    camera.ortho_height = 0, camera.vertical_fov = from_to(pi / 2, 2 * std::atan(0.5f));
    const float middle = std::tan(pi / 8 + std::atan(0.5f) / 2);
    EXPECT_NEAR(motion(scene), 2 * std::sqrt(2.0f) * middle * (1 / 0.5f - 1), 1e-2f);
}

// A tenth of a radian, of one radian across the image's height.
TEST(ShutterPoints, AMapAroundTheSceneTurns) {
    Scene scene = seen_from_the_front();
    scene.cameras[0].ortho_height = 0, scene.cameras[0].vertical_fov = 1.0f;
    EXPECT_FALSE(moves_while_open(scene, 0, second));
    scene.background.rotation = from_to(0.2f, 0.3f);
    EXPECT_TRUE(moves_while_open(scene, 0, second));
    EXPECT_NEAR(image_motion(scene, 0, ivec2(side), 0, second), 0.1f * side, 1e-3f);
    scene.background.rotation = 0.0f;
    scene.environment.emplace().map.rotation = from_to(0.3f, 0.2f);
    EXPECT_TRUE(moves_while_open(scene, 0, second));
    EXPECT_NEAR(image_motion(scene, 0, ivec2(side), 0, second), 0.1f * side, 1e-3f);
}
}
}

#include "support/expect.h"
#include "trace/moment.h"
#include "trace/snapshot.h"
#include "viewer/fixtures.h"
#include "viewer/state/camera_control.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr float tolerance = 1e-5f; // a few roundings of numbers up to 10

Viewpoint example() { return {look_at({0, 1, 4}, {0, 1, 0}, {0, 1, 0}, 0.8f), 4}; }

void expect_orthonormal(const Camera& camera) {
    expect_near(glm::cross(camera.right, camera.up), -camera.forward, tolerance);
    EXPECT_NEAR(glm::length(camera.right), 1, tolerance);
    EXPECT_NEAR(glm::length(camera.up), 1, tolerance);
}
}

TEST(CameraControl, OrbitKeepsTheTargetAndTheDistance) {
    Viewpoint view = example();
    for (int i = 0; i < 50; ++i) view = orbited(view, {0.37f, 0.05f * static_cast<float>(i % 7 - 3)});
    EXPECT_NEAR(glm::distance(view.target(), vec3(0, 1, 0)), 0, 1e-4f);
    EXPECT_NEAR(glm::distance(view.camera.position, vec3(0, 1, 0)), 4, 1e-4f);
    expect_orthonormal(view.camera);
}

TEST(CameraControl, AHandThatMovesRightBringsTheCameraToTheLeft) {
    const Viewpoint view = orbited(example(), {pi / 2, 0});
    expect_near(view.camera.position, {-4, 1, 0}, tolerance);
    expect_near(view.camera.forward, {1, 0, 0}, tolerance);
}

TEST(CameraControl, AHandThatMovesDownBringsTheCameraUpButNotOverThePole) {
    EXPECT_NEAR(orbited(example(), {0, -pi / 6}).camera.position.y, 1 + 4 * 0.5f, tolerance);
    const Viewpoint top = orbited(example(), {0, -3});
    EXPECT_LT(top.camera.forward.y, -0.999f);
    EXPECT_LT(top.camera.forward.z, 0); // still from the front
    expect_orthonormal(top.camera);
}

TEST(CameraControl, TurningKeepsThePosition) {
    const Viewpoint view = turned(example(), {pi / 2, 0});
    expect_near(view.camera.position, {0, 1, 4}, tolerance);
    expect_near(view.camera.forward, {1, 0, 0}, tolerance);
}

TEST(CameraControl, PanningByAPictureHeightMovesTheTargetOutOfThePicture) {
    const Viewpoint view = panned(example(), {0, 1});
    const std::optional<vec2> at = pixel_of(view.camera, {100, 100}, {0, 1, 0});
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x, 50, 1e-3f);
    EXPECT_NEAR(at->y, -50, 1e-3f); // from the middle, up by 100
}

TEST(CameraControl, DollyHalvesTheDistanceAndWidensNothing) {
    const Viewpoint view = dollied(example(), 0.5f);
    expect_near(view.camera.position, {0, 1, 2}, tolerance);
    expect_near(view.target(), {0, 1, 0}, tolerance);
    EXPECT_EQ(view.camera.vertical_fov, 0.8f);
}

TEST(CameraControl, FlyingGoesWhereTheCameraLooks) {
    expect_near(flown(turned(example(), {pi / 2, 0}), {1, 2, 3}).camera.position, {0 + 3, 1 + 2, 4 + 1}, tolerance);
}

TEST(CameraControl, TheSceneSaysWhatTheCameraTurnsAround) {
    const auto scene = small_scene();
    EXPECT_NEAR(viewpoint_of(*scene, 0, 0).distance, 4, tolerance);
    expect_near(viewpoint_of(*scene, 1, 1).target(), {0, 1, 0}, tolerance);
}
}

#include "modes/history.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
TEST(History, GoesOnWhileThePictureDoes) {
    Scene scene;
    Snapshot snapshot;
    snapshot.scene = &scene, snapshot.bounds = {vec3(-10), vec3(10)};
    View view;
    Settings settings;
    History history;
    const auto next = [&] { return follow(history, view, snapshot, settings); };
    EXPECT_EQ(next(), 0);
    EXPECT_EQ(next(), 1);
    view.camera.position.x += 0.5f;
    view.frame = 17;
    EXPECT_EQ(next(), 2);

    history.froxels = std::shared_ptr<FroxelHistory>(std::shared_ptr<int>(), nullptr);
    const auto resets = [&](const auto& change) {
        next(), next();
        change();
        return next() == 0;
    };
    EXPECT_TRUE(resets([&] { view.camera.position.x += 5; })) << "jump";
    EXPECT_TRUE(resets([&] { view.camera.forward = vec3(1, 0, 0); })) << "turn";
    EXPECT_TRUE(resets([&] { view.camera.vertical_fov *= 1.1f; })) << "lens";
    EXPECT_TRUE(resets([&] { view.camera.name = "other"; })) << "camera";
    EXPECT_TRUE(resets([&] { view.size.x += 1; })) << "size";
    EXPECT_TRUE(resets([&] { settings.march.step_depth *= 0.5f; })) << "settings";
    snapshot.lights = {Light{}, Light{}};
    EXPECT_TRUE(resets([&] { snapshot.lights.pop_back(); })) << "a light out";
    EXPECT_TRUE(resets([&] { snapshot.lights[0].intensity *= 2.1f; })) << "a light switched up";
    EXPECT_TRUE(resets([&] { snapshot.lights[0].intensity.y *= 0.4f; })) << "a light of another colour";
    EXPECT_TRUE(resets([&] { snapshot.lights[0].intensity *= 0.6f; })) << "a light dimmed at once";
    EXPECT_FALSE(resets([&] { snapshot.lights[0].intensity *= 0.85f; })) << "a light that flickers";
    view.camera.position = vec3(0), snapshot.lights[0].position = vec3(0, 0, -5);
    EXPECT_TRUE(resets([&] { snapshot.lights[0].position.x += 0.005f; })) << "a light that moves";
    EXPECT_FALSE(resets([&] { snapshot.lights[0].position.x += 0.002f; })) << "a light that hardly moves";
    snapshot.lights[0].kind = LightKind::sun;
    EXPECT_TRUE(resets([&] { snapshot.lights[0].direction.x += 0.001f; })) << "a sun that moves";
    Scene other;
    EXPECT_TRUE(resets([&] { snapshot.scene = &other; })) << "scene";
}
}
}

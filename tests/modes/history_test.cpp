#include "modes/history.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "scene/scene.h"
#include "trace/small_scenes.h"
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
    const auto next = [&] { return update_history(history, view, snapshot, settings); };
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
    EXPECT_TRUE(resets([&] { snapshot.lights[0].intensity.y *= 0.4f; })) << "a light of another color";
    EXPECT_TRUE(resets([&] { snapshot.lights[0].intensity *= 0.6f; })) << "a light dimmed at once";
    EXPECT_FALSE(resets([&] { snapshot.lights[0].intensity *= 0.85f; })) << "a light that flickers";
    EXPECT_TRUE(resets([&] { snapshot.ambient = vec3(1); })) << "ambient light switched on";
    EXPECT_FALSE(resets([&] { snapshot.ambient = vec3(0.9f); })) << "less of it";
    view.camera.position = vec3(0), snapshot.lights[0].position = vec3(0, 0, -5);
    EXPECT_TRUE(resets([&] { snapshot.lights[0].position.x += 0.005f; })) << "a light that moves";
    EXPECT_FALSE(resets([&] { snapshot.lights[0].position.x += 0.002f; })) << "a light that hardly moves";
    snapshot.lights[0].kind = LightKind::sun;
    EXPECT_TRUE(resets([&] { snapshot.lights[0].direction.x += 0.001f; })) << "a sun that moves";
    history.froxels = nullptr;
    snapshot.lights[0].kind = LightKind::spot;
    EXPECT_TRUE(resets([&] { snapshot.lights[0].outer_cone *= 0.99f; })) << "a beam that gets narrow";
    LightFilter filter;
    const auto filtered = [&](const auto& change) {
        return resets([&] { change(), snapshot.lights[0].filter = std::make_shared<LightFilter>(filter); });
    };
    EXPECT_TRUE(filtered([&] { filter.gobo = board_gobo(2, 4, vec3(1), vec3(0)); })) << "a gobo put in";
    EXPECT_FALSE(filtered([] {})) << "the same gobo";
    EXPECT_TRUE(filtered([&] { filter.gobo = board_gobo(3, 4, vec3(1), vec3(0)); })) << "its next image";
    EXPECT_TRUE(filtered([&] { filter.gobo_axes = light_axes(filter.direction, {0, 1, 0}, 0.1f); })) << "a turn of it";
    EXPECT_TRUE(filtered([&] { filter.gobo_half *= 1.1f; })) << "a larger one";
    AreaShape shape;
    const auto shaped = [&](const auto& change) {
        return resets([&] { change(), snapshot.lights[0].area = std::make_shared<AreaShape>(shape); });
    };
    EXPECT_TRUE(shaped([] {})) << "a face instead of a spot";
    EXPECT_FALSE(shaped([] {})) << "the same face";
    EXPECT_TRUE(shaped([&] { shape.right = vec3(0, 0, 1), shape.up = vec3(1, 0, 0); })) << "a face turned in its plane";
    EXPECT_TRUE(shaped([&] { shape.half *= 1.1f; })) << "a larger face";
    Scene other;
    EXPECT_TRUE(resets([&] { snapshot.scene = &other; })) << "scene";
}
}
}

// Rectangles, discs and spheres of scene files.
#include "base/error.h"
#include "scene/lights/area_shape.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
Scene scene_with(const std::string& lights) {
    return load_scene_text(R"({"tyndall": 1, "lights": [)" + lights + "]}", "scene.json");
}
std::string refusal(const std::string& light) {
    return error_message(ExitCode::refused, [&] { scene_with(light); });
}

TEST(SceneFaces, AreReadWithTheirSizes) {
    const Scene scene = scene_with(
        R"({"type": "rectangle", "name": "box", "position": [0, 2, 0], "target": [0, 0, 0], "up": [0, 0, 1], "width": 2,
            "height": {"keys": [[0, 1], [1, 3]]}, "intensity": 5, "two_sided": true, "visible": false},
           {"type": "disc", "position": [0, 2, 0], "direction": [1, 0, 0], "radius": 0.5, "intensity": 5},
           {"type": "point", "position": [0, 2, 0], "intensity": 5},
           {"type": "sphere", "position": [0, 2, 0], "radius": 0.25, "intensity": 5, "shadows": false})");
    const Snapshot snapshot = make_snapshot(scene, Moment{24, 1});
    ASSERT_EQ(snapshot.lights.size(), 4u);
    EXPECT_FALSE(snapshot.lights[0].area) << "faces stand after all others";
    const AreaShape &box = *snapshot.lights[1].area, &disc = *snapshot.lights[2].area, &ball = *snapshot.lights[3].area;
    EXPECT_EQ(snapshot.lights[1].name, "box");
    EXPECT_EQ(box.kind, LightKind::rectangle);
    EXPECT_EQ(box.half, vec2(1, 1.5f));
    EXPECT_EQ(box.normal, vec3(0, -1, 0));
    EXPECT_NEAR(box.up.z, 1, 1e-6);
    EXPECT_TRUE(box.two_sided);
    EXPECT_FALSE(box.visible);
    EXPECT_NEAR(radiance_of(snapshot.lights[1]).x, 5, 1e-5);
    EXPECT_EQ(disc.kind, LightKind::disc);
    EXPECT_EQ(disc.half, vec2(0.5f));
    EXPECT_EQ(disc.normal, vec3(1, 0, 0));
    EXPECT_TRUE(disc.visible);
    EXPECT_FALSE(disc.two_sided);
    EXPECT_EQ(ball.kind, LightKind::sphere);
    EXPECT_NEAR(radiance_of(snapshot.lights[3]).x, 5, 1e-5);
    EXPECT_FALSE(snapshot.lights[3].shadows);
}

TEST(SceneFaces, WhatDoesNotFitIsRefused) {
    const std::string place = R"("position": [0, 0, 0], "intensity": 1, )",
                      aimed = place + R"("direction": [0, -1, 0], )";
    const auto expect = [](const std::string& light, const std::string& where, const std::string& what) {
        const std::string text = refusal("{" + light + "}");
        EXPECT_NE(text.find(where), std::string::npos) << text;
        EXPECT_NE(text.find(what), std::string::npos) << text;
    };
    expect(aimed + R"("type": "rectangle", "width": 1)", "/lights/0", "needs a height");
    expect(aimed + R"("type": "rectangle", "width": 1, "height": 0)", "/lights/0/height", "0");
    expect(aimed + R"("type": "rectangle", "width": 1, "height": 1, "radius": 1)", "/lights/0/radius",
           "this light is a rectangle");
    expect(aimed + R"("type": "disc")", "/lights/0", "needs a radius");
    expect(aimed + R"("type": "disc", "radius": {"keys": [[0, 1], [1, 0]]})", "/lights/0/radius", "greater than 0");
    expect(place + R"("type": "disc", "radius": 1)", "/lights/0", "needs a direction");
    expect(aimed + R"("type": "sphere", "radius": 1)", "/lights/0/direction", "this light is a sphere");
    expect(place + R"("type": "sphere", "radius": 1, "two_sided": true)", "/lights/0/two_sided",
           "rectangles and discs");
    expect(place + R"("type": "sphere", "radius": 1, "range": 4)", "/lights/0/range", "point lights and spots");
    expect(place + R"("type": "point", "visible": false)", "/lights/0/visible", "environments, rectangles");
    expect(place + R"("type": "point", "width": 1)", "/lights/0/width", "rectangles only");
    expect(aimed + R"("type": "disc", "radius": 1, "up": [0, 0, 1])", "/lights/0/up", "rectangles");
}
}
}

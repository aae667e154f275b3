#include "scene/scene.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
Scene scene_at(const char* x, const std::string& more = "") {
    const TempFolder folder;
    const std::string at(x);
    return load_scene_text(R"({"tyndall": 1, "camera": {"position": [)" + at + R"(.25, 2, 5], "target": [)" + at +
                               R"(.25, 1, 0]}, "lights": [{"type": "spot", "intensity": 1, "position": [)" + at +
                               R"(.5, 3, 0], "target": [)" + at + R"(.5, 0, 1]}], "media": [)" + more + "]}",
                           folder / "scene.json");
}

TEST(Origin, IsZeroForScenesAround) {
    for (const char* x : {"0", "7", "-250"}) EXPECT_EQ(scene_at(x).origin, dvec3(0)) << x;
}

TEST(Origin, PlacesKeepTheirDigitsFarOut) {
    const Scene scene =
        scene_at("10000000", R"({"type": "homogeneous", "extinction": 1, "bounds": {"low": [10000000.125, 0, 0],
        "high": [10000001, 1, 1]}}, {"type": "height", "extinction": 1, "base": 2, "falloff": 1, "translate": [10000000.75, 0, 0]})");
    ASSERT_GT(scene.origin.x, 9e6);
    const auto in_world = [&](vec3 place) { return (dvec3(place) + scene.origin).x; };
    EXPECT_EQ(in_world(scene.cameras[0].position.at(0)), 10000000.25);
    EXPECT_EQ(in_world(scene.lights[0].position.at(0)), 10000000.5);
    EXPECT_EQ(scene.lights[0].direction.at(0), vec3(0, -3, 1));
    EXPECT_EQ(in_world(scene.media[0].bounds.low), 10000000.125);
    EXPECT_EQ(scene.media[0].translation.at(0), vec3(0));
    EXPECT_EQ(in_world(scene.media[1].translation.at(0)), 10000000.75);
    EXPECT_EQ(scene.media[1].height_base.at(0), 2);
}

TEST(Origin, HeightsKeepTheirDigitsFarUp) {
    const TempFolder folder;
    const Scene scene =
        load_scene_text(R"({"tyndall": 1, "camera": {"position": [0, 10000002, 5], "target": [0, 10000001, 0]},
        "media": [{"type": "height", "extinction": 1, "base": 10000000.2, "falloff": 0.6}]})",
                        folder / "scene.json");
    ASSERT_GT(scene.origin.y, 9e6);
    EXPECT_NEAR(double{scene.media[0].height_base.at(0)} + scene.origin.y, 10000000.2, 1e-6);
}

TEST(Origin, NodesAreComposedInDouble) {
    Scene scene;
    Node root, child;
    root.translation = vec3(1e7f, 0, 0), root.remainder = dvec3(0.3, 0, 0);
    root.scale = vec3(2);
    child.parent = 0, child.translation = vec3(-5e6f, 0, 0), child.remainder = dvec3(0.01, 0, 0);
    scene.nodes = {root, child};
    scene.origin = dvec3(0, 4, 0);
    EXPECT_FLOAT_EQ(node_matrix(scene, 1, 0)[3].x, 0.32f);
    EXPECT_EQ(node_matrix(scene, 1, 0)[3].y, -4);
    EXPECT_EQ(node_matrix(scene, -1, 0)[3].y, -4);
}
}
}

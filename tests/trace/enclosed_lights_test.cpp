// Lamps in bulbs are found; shades, housings and rooms are none.
#include "trace/lights/enclosed_lights.h"

#include "scene/scene.h"
#include "support/meshes.h"
#include "trace/small_scenes.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// A ball around the origin with holes above `top` and below `bottom`, degrees from the upper and the lower pole.
Mesh ball(float radius, float top = 0, float bottom = 0, int material = -1) {
    constexpr int rings = 24, sides = 32;
    Mesh mesh;
    for (int ring = 0; ring <= rings; ++ring) {
        const float theta = glm::radians(top + (180 - top - bottom) * static_cast<float>(ring) / rings);
        for (int side = 0; side < sides; ++side) {
            const float phi = 2 * pi * static_cast<float>(side) / sides;
            mesh.positions.push_back(
                radius * vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
        }
    }
    const auto at = [&](int ring, int side) { return static_cast<uint32_t>(ring * sides + side % sides); };
    for (int ring = 0; ring < rings; ++ring)
        for (int side = 0; side < sides; ++side) {
            mesh.triangles.push_back({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1)});
            mesh.triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring, side + 1)});
        }
    mesh.material = material;
    return mesh;
}

// A lamp above a floor of 6 m, seen by a camera from some meters away; meshes around the lamp are "Globe".
Scene lamp_in(Mesh mesh, vec3 eye = vec3(0, 1.5f, 5)) {
    Scene scene;
    scene.materials = {blend_material(0.3f)};
    add_mesh(scene, floor_of(0, 3));
    Node node;
    node.name = "Globe", node.translation = vec3(0, 1, 0);
    add_mesh(scene, std::move(mesh), node);
    LightSource light;
    light.name = "lamp", light.position = vec3(0, 1, 0);
    scene.lights = {light};
    CameraSource camera;
    camera.position = eye, camera.target = vec3(0, 1, 0.01f);
    scene.cameras = {camera};
    return scene;
}

size_t found(const Scene& scene) { return enclosed_lights(scene).size(); }

TEST(EnclosedLights, ALampInABulbIsToldWithItsNames) {
    const std::vector<std::string> lines = enclosed_lights(lamp_in(ball(0.03f)));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0],
              "light lamp is enclosed by the object \"Globe\": 100 % of its light is blocked within 0.03 m; to "
              "let it through, add {\"name\": \"Globe\", \"casts_shadows\": false} to \"objects\"");
    EXPECT_EQ(found(lamp_in(box_of(vec3(-0.05f), vec3(0.05f)))), 1u);
    EXPECT_EQ(found(lamp_in(ball(0.03f, 0, 20))), 1u) << "an open socket";
    EXPECT_EQ(found(lamp_in(ball(0.2f))), 1u) << "a large globe";

    Scene moved = lamp_in(ball(0.03f));
    moved.lights[0].position = vec3(0, 1.02f, 0.01f);
    EXPECT_EQ(found(moved), 1u) << "not in its middle";
}

TEST(EnclosedLights, ASpotOnSomethingNearIsFree) {
    Scene scene = lamp_in(box_of(vec3(-0.5f, -0.5f, -0.5f), vec3(0.5f, -0.3f, 0.5f)));
    scene.lights[0].kind = LightKind::spot, scene.lights[0].outer_cone = 0.3f;
    EXPECT_EQ(found(scene), 0u);
    scene = lamp_in(ball(0.03f));
    scene.lights[0].kind = LightKind::spot, scene.lights[0].outer_cone = 0.3f;
    EXPECT_EQ(found(scene), 1u) << "its bulb is all around";
}

TEST(EnclosedLights, WhatIsMendedIsNotTold) {
    Scene scene = lamp_in(ball(0.03f));
    scene.instances[1].casts_shadows = false;
    EXPECT_EQ(found(scene), 0u);
    scene.instances[1].casts_shadows = true, scene.lights[0].casters = {true, false};
    EXPECT_EQ(found(scene), 0u);
    scene.lights[0].casters.clear(), scene.lights[0].shadows = false;
    EXPECT_EQ(found(scene), 0u);
    EXPECT_EQ(found(lamp_in(ball(0.03f, 0, 0, 0))), 0u) << "glass";
    Scene inside = lamp_in(ball(0.03f));
    inside.lights[0].radius = 0.04f; // nothing within the lamp's own ball casts shadows
    EXPECT_EQ(found(inside), 0u);
}

TEST(EnclosedLights, ShadesHousingsAndRoomsAreNone) {
    EXPECT_EQ(found(lamp_in(ball(0.15f, 50, 50))), 0u) << "a shade, open above and below";
    EXPECT_EQ(found(lamp_in(ball(0.15f, 0, 60))), 0u) << "a bowl";

    // A spot in a can that is open to its beam; turned around it lights the can alone.
    Scene spot = lamp_in(ball(0.05f, 0, 40));
    spot.lights[0].kind = LightKind::spot, spot.lights[0].direction = vec3(0, -1, 0);
    spot.lights[0].outer_cone = 0.5f;
    EXPECT_EQ(found(spot), 0u);
    spot.lights[0].direction = vec3(0, 1, 0);
    EXPECT_EQ(found(spot), 1u);

    EXPECT_EQ(found(lamp_in(box_of({-3, -1, -3}, {3, 2, 3}), {0, 1.5f, 2.5f})), 0u) << "a room with the camera";
    EXPECT_EQ(found(lamp_in(box_of({-2, -0.9f, -2}, {2, 1.5f, 2}), {0, 1.5f, 4})), 0u) << "a room seen from outside";
    EXPECT_EQ(found(lamp_in(ball(0.2f), {0, 1.1f, 0.1f})), 0u) << "the camera inside too";

    Scene sun = lamp_in(ball(0.03f));
    sun.lights[0].kind = LightKind::sun, sun.lights[0].direction = vec3(0, -1, 0);
    EXPECT_EQ(found(sun), 0u);
}

TEST(EnclosedLights, FogDoesNotHideThem) {
    Scene scene = lamp_in(ball(0.03f));
    MediumSource fog;
    fog.bounds = {vec3(-3, 0, -3), vec3(3)};
    scene.media = {fog};
    EXPECT_EQ(found(scene), 1u);
    EXPECT_EQ(enclosed_lights(make_snapshot(scene, moment_of(scene, 1))).size(), 1u);
}
}
}

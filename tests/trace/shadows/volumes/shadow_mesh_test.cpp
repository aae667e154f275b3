// The mesh that shadow volumes are made of: what is joined in it, and what of it a light reaches.
#include "scene/light.h"
#include "trace/shadows/volumes/shadow_stage.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
TEST(ShadowMesh, JoinsWhatIsAtTheSamePlace) {
    const ShadowMesh box = make_shadow_mesh(triangles_of({box_of(vec3(0), vec3(1))}));
    EXPECT_EQ(box.corners.size(), 8u);
    EXPECT_EQ(box.edges.size(), 18u); // 12 and a diagonal on each side
    EXPECT_EQ(box.triangles.size(), 12u);
    // -0 is 0; a triangle without area is none; alpha casts nothing here.
    const vec3 x(1, 0, 0), y(0, 1, 0);
    const ShadowMesh two =
        make_shadow_mesh({{{vec3(0), x, y}}, {{vec3(-0.0f), y, -x}}, {{x, x, y}}, {{x, y, -y}, true}});
    EXPECT_EQ(two.corners.size(), 4u);
    EXPECT_EQ(two.edges.size(), 5u);
    EXPECT_EQ(two.triangles.size(), 2u);
}

// What a light reaches is as dark as before from every point of its ball; most of what it does not reach is gone.
TEST(ShadowMesh, WhatALightReachesKeepsItsShadows) {
    Light spot, lamp;
    spot.kind = LightKind::spot, spot.position = vec3(0.5f, 3.4f, -0.4f), spot.radius = 0.2f;
    spot.direction = glm::normalize(vec3(0.2f, -1, 0.3f)), spot.outer_cone = 0.25f;
    lamp.position = vec3(0.1f, 0.2f, 0.3f), lamp.range = 1.5f, lamp.radius = 0.1f;
    const auto whole = std::make_shared<const ShadowMesh>(make_shadow_mesh(triangles_of(random_boxes(40))));
    for (const Light& light : {spot, lamp}) {
        const auto part = mesh_in_reach(whole, light);
        EXPECT_LT(part->triangles.size(), whole->triangles.size() / 2);
        EXPECT_LT(part->corners.size(), whole->corners.size() / 2);
        EXPECT_LT(part->edges.size(), whole->edges.size() / 2);
        int reached = 0, shaded = 0;
        for (uint32_t i = 0; i < 50000; ++i) {
            LightPoint point = center_of(light);
            point.at += 0.99 * double{light.radius} * dvec3(random_direction(i % 20, 31));
            const dvec3 at(random_point(i, 32, room));
            if (!(max_component(arrival(light, vec3(at)).irradiance) > 0)) continue;
            const int dark = count_between(make_shadow_volumes(whole, point), at);
            ASSERT_EQ(count_between(make_shadow_volumes(part, point), at), dark);
            ++reached, shaded += dark > 0;
        }
        EXPECT_GT(shaded, 50);
        EXPECT_GT(reached - shaded, 50);
    }
    Light sun;
    sun.kind = LightKind::sun;
    EXPECT_EQ(mesh_in_reach(whole, sun), whole);
}
}
}

#include "base/random.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "trace/occlusion/occluders.h"
#include "trace/surface.h"

#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/transmittance/light_transmittance.h"
#include "volume/fog_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

Light sun(float elevation, vec3 lux) {
    Light light;
    light.kind = LightKind::sun;
    light.direction = {-std::cos(elevation), -std::sin(elevation), 0};
    light.intensity = lux;
    return light;
}

// Ground at y = 0, seen from above.
SurfacePoint ground_point(vec3 position = vec3(0)) {
    SurfacePoint point;
    point.position = position;
    point.base_color = vec3(0.5f, 0.25f, 1);
    return point;
}

struct Shaded {
    vec3 radiance;
    std::vector<vec3> per_light;
};

Shaded shade(const Snapshot& snapshot, const SurfacePoint& point, vec2 u = vec2(0.5f)) {
    std::vector<LightDepth> depths;
    for (const Light& light : snapshot.lights)
        depths.push_back(make_light_depth(snapshot, light, LightTransmittance::grid, 16));
    Shaded result;
    shade_surfaces(snapshot, depths, {&point, 1}, {&u, 1}, {&result.radiance, 1}, &result.per_light);
    return result;
}

void expect_color(vec3 found, vec3 expected, float relative = 2e-6f) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], relative * std::abs(expected[i]) + 1e-12f) << i;
}

TEST(Surface, LambertUnderTheSun) {
    Snapshot snapshot;
    const float elevation = 0.7f;
    snapshot.lights = {sun(elevation, vec3(10, 20, 30))};
    const SurfacePoint point = ground_point();
    expect_color(shade(snapshot, point).radiance, point.base_color / pi * vec3(10, 20, 30) * std::sin(elevation));
    snapshot.lights[0].surface_scale = 0.5f;
    expect_color(shade(snapshot, point).radiance, point.base_color / pi * vec3(5, 10, 15) * std::sin(elevation));
    // From below nothing arrives.
    snapshot.lights[0].direction.y *= -1;
    expect_color(shade(snapshot, point).radiance, vec3(0));
}

TEST(Surface, LocalLightsFallOffAndAddUp) {
    Snapshot snapshot;
    Light lamp;
    lamp.position = vec3(0, 2, 0);
    lamp.intensity = vec3(8);
    Light spot = lamp;
    spot.kind = LightKind::spot;
    spot.position = vec3(3, 4, 0), spot.direction = glm::normalize(vec3(-3, -4, 0));
    spot.inner_cone = 0.1f, spot.outer_cone = 0.2f;
    snapshot.lights = {lamp, spot};
    const SurfacePoint point = ground_point();
    const Shaded shaded = shade(snapshot, point);
    ASSERT_EQ(shaded.per_light.size(), 2u);
    expect_color(shaded.per_light[0], point.base_color / pi * (8.0f / 4));
    expect_color(shaded.per_light[1], point.base_color / pi * (8.0f / 25 * 0.8f));
    expect_color(shaded.radiance, shaded.per_light[0] + shaded.per_light[1]);
}

TEST(Surface, AmbientAndEmissionNeedNoLight) {
    Snapshot snapshot;
    snapshot.ambient = vec3(2, 3, 4);
    SurfacePoint point = ground_point();
    point.emission = vec3(1, 0, 5);
    expect_color(shade(snapshot, point).radiance, point.base_color * vec3(2, 3, 4) + vec3(1, 0, 5));
}

TEST(Surface, ShadowsFollowTheSceneAndTheSwitch) {
    Scene scene;
    scene.materials = {blend_material(0.25f)};
    add_mesh(scene, quad(vec3(-5, 0, -5), vec3(10, 0, 0), vec3(0, 0, 10)));
    add_mesh(scene, quad(vec3(0, 1, -1), vec3(2, 0, 0), vec3(0, 0, 2)));
    add_mesh(scene, quad(vec3(-2, 1, -1), vec3(1, 0, 0), vec3(0, 0, 2), 0));
    Snapshot snapshot;
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    snapshot.lights = {sun(pi / 2, vec3(pi))};
    EXPECT_EQ(shade(snapshot, ground_point(vec3(1, 0, 0))).radiance, vec3(0));
    expect_color(shade(snapshot, ground_point(vec3(3, 0, 0))).radiance, vec3(0.5f, 0.25f, 1));
    expect_color(shade(snapshot, ground_point(vec3(-1.5f, 0, 0))).radiance, 0.75f * vec3(0.5f, 0.25f, 1));
    snapshot.lights[0].shadows = false;
    expect_color(shade(snapshot, ground_point(vec3(1, 0, 0))).radiance, vec3(0.5f, 0.25f, 1));
}

// Half of a soft light behind an edge: half of its light on average.
// The ceiling is less above the lamp than rays start from the floor.
TEST(Surface, LampsJustBelowACeilingLightTheFloorFarFromTheOrigin) {
    for (const float x : {0.0f, 100.0f, 150.0f, 700.0f}) {
        Scene scene;
        add_mesh(scene, quad({x - 2, 3, -2}, {4, 0, 0}, {0, 0, 4}));
        Snapshot snapshot;
        snapshot.scene = &scene, snapshot.occluders = Occluders::make(scene, 0, nullptr);
        Light lamp;
        lamp.kind = LightKind::point, lamp.position = {x, 2.9999f, 0}, lamp.intensity = vec3(9);
        snapshot.lights = {lamp};
        const SurfacePoint below = ground_point({x, 0, 0});
        expect_color(shade(snapshot, below).radiance, below.base_color / pi, 2e-4f);
        snapshot.lights[0].position.y = 3.01f;
        expect_color(shade(snapshot, below).radiance, vec3(0));
    }
}

TEST(Surface, SoftLightsHavePenumbras) {
    Scene scene;
    add_mesh(scene, quad(vec3(0, 1, -5), vec3(5, 0, 0), vec3(0, 0, 10)));
    Snapshot snapshot;
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    Light lamp;
    lamp.position = vec3(0, 2, 0);
    lamp.radius = 0.2f;
    lamp.intensity = vec3(4 * pi);
    snapshot.lights = {lamp};
    SurfacePoint points[16];
    vec2 u[16];
    vec3 radiance[16];
    float mean = 0;
    for (uint32_t packet = 0; packet < 64; ++packet) {
        for (uint32_t i = 0; i < 16; ++i) {
            points[i].position = vec3(0);
            const Sample2 random = sample2(packet * 16 + i, 1);
            u[i] = {random.x, random.y};
        }
        shade_surfaces(snapshot, {}, points, u, radiance);
        for (const vec3 r : radiance) mean += r.x / 1024;
    }
    EXPECT_NEAR(mean, 0.5f, 0.01f);

    // Several points of the light at once, for two surface points.
    vec2 many[64];
    for (uint32_t i = 0; i < 64; ++i) {
        const Sample2 random = sample2(i, 2);
        many[i] = {random.x, random.y};
    }
    shade_surfaces(snapshot, {}, {points, 2}, many, radiance);
    for (size_t point = 0; point < 2; ++point) {
        float expected = 0;
        for (size_t i = 0; i < 32; ++i) {
            vec3 one;
            shade_surfaces(snapshot, {}, {points, 1}, {&many[32 * point + i], 1}, {&one, 1});
            expected += one.x / 32;
        }
        EXPECT_NEAR(radiance[point].x, expected, 1e-5f);
        EXPECT_NEAR(radiance[point].x, 0.5f, 0.1f);
    }
}

TEST(Surface, LightIsDimmedByTheFogItCrosses) {
    Snapshot snapshot;
    snapshot.media = {homogeneous_medium(0.5f, {vec3(-10, 0, -10), vec3(10, 3, 10)})};
    snapshot.lights = {sun(pi / 2, vec3(pi))};
    expect_color(shade(snapshot, ground_point()).radiance, vec3(0.5f, 0.25f, 1) * std::exp(-1.5f), 1e-5f);
}

// One batch equals its points one by one.
TEST(Surface, BatchesOfAnySize) {
    Snapshot snapshot;
    Light lamp;
    lamp.position = vec3(0, 2, 0);
    snapshot.lights = {lamp, sun(1, vec3(1))};
    SurfacePoint points[5];
    for (int i = 0; i < 5; ++i) points[i] = ground_point(vec3(i, 0, -i));
    const vec2 u[5] = {};
    vec3 radiance[5];
    shade_surfaces(snapshot, {}, points, u, radiance);
    for (int i = 0; i < 5; ++i) {
        vec3 alone;
        shade_surfaces(snapshot, {}, {&points[i], 1}, {u, 1}, {&alone, 1});
        EXPECT_EQ(alone, radiance[i]);
    }
}
}
}

// Shadow maps against distances worked out by hand.

#include "base/random.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/random_points.h"
#include "support/threads.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/maps/shadow_map.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
Light light_of(LightKind kind, vec3 position, vec3 direction) {
    Light light;
    light.kind = kind, light.position = position, light.direction = glm::normalize(direction);
    return light;
}

// Fog in a box, in front of surfaces.
struct Stage {
    Scene scene;
    Snapshot snapshot;
    View view;

    explicit Stage(std::vector<Mesh> meshes, Box fog = {vec3(-4), vec3(4)}, std::vector<Material> materials = {}) {
        scene.materials = std::move(materials);
        for (Mesh& mesh : meshes) add_mesh(scene, std::move(mesh));
        snapshot.scene = &scene;
        snapshot.occluders = Occluders::make(scene, 0, nullptr);
        Medium medium;
        medium.density.bounds = medium.world_bounds = fog;
        snapshot.media = {medium};
        snapshot.bounds = fog;
        snapshot.bounds.grow(snapshot.occluders->bounds());
        view.camera = look_at({0, 0, 12}, {0, 0, 0}, {0, 1, 0}, 1);
    }
    ShadowMap map(const Light& light, ShadowMapOptions options = {256, 1, 0, 0}) const {
        return make_shadow_map(view, snapshot, light, options);
    }
};

float share_at(const ShadowMap& map, vec3 point) {
    alignas(64) float x[16], y[16], z[16], share[16];
    std::fill_n(x, 16, point.x), std::fill_n(y, 16, point.y), std::fill_n(z, 16, point.z);
    lit_fractions(map, x, y, z, share);
    return share[0];
}

// The depth stored at texel centers, for the whole first picture.
template<class Visit> void visit_texels(const ShadowMap& map, size_t image, const Visit& visit) {
    const ShadowImage& p = map.images[image];
    for (int y = 0; y < p.size.y; ++y)
        for (int x = 0; x < p.size.x; ++x)
            visit((vec2(x, y) + 0.5f - p.offset) / p.scale, map.depth[p.first + static_cast<size_t>(y * p.size.x + x)]);
}

TEST(ShadowMap, SpotStoresTheDistanceToAWall) {
    // A wall 3 m ahead: distance 3 √(1 + u² + v²).
    const Stage stage({quad({-9, -9, -3}, {18, 0, 0}, {0, 18, 0})}, {vec3(-10), vec3(10)});
    Light light = light_of(LightKind::spot, vec3(0), {0, 0, -1});
    light.outer_cone = 0.5f;
    const ShadowMap map = stage.map(light);
    int counted = 0;
    visit_texels(map, 0, [&](vec2 at, float depth) {
        if (glm::length(at) > std::tan(0.5f)) return;
        EXPECT_NEAR(depth, 3 * std::sqrt(1 + dot(at, at)), 3e-6f);
        ++counted;
    });
    EXPECT_GT(counted, 40000); // π/4 of 250²
    EXPECT_EQ(share_at(map, {0.3f, -0.2f, -2.99f}), 1);
    EXPECT_EQ(share_at(map, {0.3f, -0.2f, -3.01f}), 0);
    EXPECT_EQ(share_at(map, {0, 0, 1}), 0) << "behind a spot";
    EXPECT_EQ(share_at(map, {3, 0, -1}), 0) << "beside its cone";
}

TEST(ShadowMap, CubeStoresTheDistanceToTheWallsOfARoom) {
    // Light off the middle of a room: the distance along unit direction d is min over axes of (wall - p) / d.
    const Box room{vec3(-2, -1, -3), vec3(2, 1.5f, 3)};
    const Stage stage({box_of(room.low, room.high)});
    const vec3 p(0.5f, 0.2f, -0.7f);
    const ShadowMap map = stage.map(light_of(LightKind::point, p, {0, -1, 0}));
    ASSERT_EQ(map.images.size(), 6u);
    for (uint32_t i = 0; i < 4000; ++i) {
        const vec3 d = random_direction(i, 3);
        const float wall = clip(room, p, d, {0, infinity}).high;
        // The distance changes by at most its size times tan 45° … 60° of angle over a texel.
        EXPECT_EQ(share_at(map, p + d * (wall * 0.97f)), 1) << i;
        EXPECT_EQ(share_at(map, p + d * (wall * 1.03f)), 0) << i;
    }
}

TEST(ShadowMap, CubeFacesMeetWithoutSeams) {
    // A ball of radius 1 around the light: the same depth everywhere, so the 16-texel filter sees a sharp step at it,
    // on edges and corners of the cube too.
    const Stage stage({box_of(vec3(-1), vec3(1))});
    const ShadowMap map = stage.map(light_of(LightKind::point, vec3(0), {0, -1, 0}), {128, 1, 2, 0});
    for (const vec3 d : {vec3(1, 1, 0), vec3(1, -1, 0), vec3(0, 1, 1), vec3(-1, 0, 1), vec3(1, 1, 1), vec3(-1, -1, 1)})
        for (int i = 0; i < 64; ++i) {
            const vec3 to = glm::normalize(d + 0.05f * random_direction(static_cast<uint32_t>(i), 5));
            const float wall = 1 / max_component(glm::abs(to));
            EXPECT_EQ(share_at(map, to * (wall * 0.95f)), 1);
            EXPECT_EQ(share_at(map, to * (wall * 1.05f)), 0);
        }
}

TEST(ShadowMap, WideSpotHasACube) {
    const Stage stage({box_of(vec3(-2), vec3(2))});
    Light light = light_of(LightKind::spot, vec3(0), {0, -1, 0});
    light.outer_cone = 80 * pi / 180;
    const ShadowMap map = stage.map(light);
    EXPECT_EQ(map.projection, LightProjection::all_around);
    EXPECT_EQ(share_at(map, {1.9f, -1.9f, 0}), 1);
    EXPECT_EQ(share_at(map, {1.9f, -2.1f, 0}), 0);
}

TEST(ShadowMap, SunStoresDepthAlongItsDirection) {
    // Floor at y = -1 under a slanted sun: a point is shaded below the floor only.
    const Stage stage({quad({-9, -1, -9}, {18, 0, 0}, {0, 0, 18})});
    const Light light = light_of(LightKind::sun, vec3(0), {0.4f, -1, 0.3f});
    const ShadowMap map = stage.map(light);
    const float texel = texel_size(map, {0, -1, 0});
    ASSERT_GT(texel, 0);
    for (uint32_t i = 0; i < 500; ++i) {
        const vec3 p = 3.0f * random_direction(i, 9);
        if (std::abs(p.y + 1) < texel) continue; // a texel's depth is the floor's at its middle
        EXPECT_EQ(share_at(map, p), p.y > -1 ? 1 : 0) << p.x << " " << p.y << " " << p.z;
    }
    EXPECT_EQ(share_at(map, {100, -5, 0}), 1) << "beside everything that casts shadows";
}

TEST(ShadowMap, NoSurfaceShadesItselfAtAnyAngle) {
    // Catalog: no self-shadow on lit planes at 1..89°, beams start within 1.5 texels. The error of a texel's depth on
    // a plane at angle a to the light is half a texel · cot a, that is half a texel · cos a off the plane, twice that
    // with the four around, and as much again across the diagonal.
    const Stage stage({quad({-40, 0, -40}, {80, 0, 0}, {0, 0, 80})});
    for (const float degrees : {1.0f, 5.0f, 30.0f, 60.0f, 89.0f})
        for (const int pcf : {0, 1}) {
            const float a = degrees * pi / 180;
            const Light light = light_of(LightKind::sun, vec3(0), {std::cos(a), -std::sin(a), 0.1f * std::cos(a)});
            const ShadowMap map = stage.map(light, {512, 1, pcf, 0});
            for (int i = 0; i < 200; ++i) {
                const vec3 at(random_unit(i, 0, 0, 1) * 6 - 3, 0, random_unit(i, 0, 1, 1) * 6 - 3);
                const float texel = texel_size(map, at);
                EXPECT_EQ(share_at(map, at + vec3(0, 1.5f * texel, 0)), 1) << degrees << " " << pcf;
                EXPECT_EQ(share_at(map, at - vec3(0, 1.5f * texel, 0)), 0) << degrees << " " << pcf;
            }
        }
}

TEST(ShadowMap, FiltersBlendAStraightEdge) {
    // A half plane under the sun, its edge between two texel middles: nearest is a step, bilinear a ramp one texel
    // wide, sixteen texels a ramp three wide.
    const Stage stage({quad({0, 0, -9}, {9, 0, 0}, {0, 0, 18})});
    const Light light = light_of(LightKind::sun, vec3(0), {0, -1, 0});
    for (const int pcf : {0, 1, 2}) {
        const ShadowMap map = stage.map(light, {64, 1, pcf, 0});
        const ShadowImage& image = map.images[0];
        const vec3 u(map.world_to_map[0][0], map.world_to_map[1][0], map.world_to_map[2][0]);
        ASSERT_NEAR(std::abs(u.x), 1, 1e-6f);
        // Texel number of the border between the last lit and the first dark texel.
        const float edge = -dot(u, map.position) * image.scale.x + image.offset.x;
        const float border = std::round(edge);
        const float sign = u.x > 0 ? 1.0f : -1.0f; // towards the dark
        const float width = pcf == 0 ? 0.0f : pcf == 1 ? 1.0f : 3.0f;
        for (const float off : {-2.2f, -1.4f, -0.9f, -0.45f, -0.2f, 0.1f, 0.3f, 0.48f, 0.8f, 1.3f, 2.1f}) {
            const float texel = border + sign * off;
            const vec3 point = map.position + u * ((texel - image.offset.x) / image.scale.x);
            const float expected = pcf == 0 ? (off < 0 ? 1.0f : 0.0f) : std::clamp(0.5f - off / width, 0.0f, 1.0f);
            EXPECT_NEAR(share_at(map, {point.x, -1, 0}), expected, 1e-3f) << pcf << " " << off;
        }
    }
}

TEST(ShadowMap, MaskHolesArePassedAndThinSheetsToo) {
    for (const float alpha : {0.3f, 0.7f}) {
        const Stage stage({quad({-9, 1, -9}, {18, 0, 0}, {0, 0, 18}, 0), quad({-9, -2, -9}, {18, 0, 0}, {0, 0, 18})},
                          {vec3(-4), vec3(4)}, {blend_material(alpha)});
        const ShadowMap map = stage.map(light_of(LightKind::sun, vec3(0), {0.1f, -1, 0}));
        EXPECT_EQ(share_at(map, {0, 2, 0}), 1);
        EXPECT_EQ(share_at(map, {0, 0, 0}), alpha < 0.5f ? 1 : 0);
        EXPECT_EQ(share_at(map, {0, -2.2f, 0}), 0);
    }
}

TEST(ShadowMap, BiasMovesSurfacesAway) {
    const Stage stage({quad({-9, 0, -9}, {18, 0, 0}, {0, 0, 18})});
    const Light light = light_of(LightKind::sun, vec3(0), {0, -1, 0});
    const ShadowMap map = stage.map(light, {64, 1, 0, 2});
    const float texel = texel_size(map, {0, 0, 0});
    EXPECT_EQ(share_at(map, {0, -1.9f * texel, 0}), 1);
    EXPECT_EQ(share_at(map, {0, -2.1f * texel, 0}), 0);
}

// A street of blocks to the horizon.
Stage street() {
    std::vector<Mesh> meshes{quad({-40, 0, -200}, {80, 0, 0}, {0, 0, 210})};
    for (int i = 0; i < 20; ++i) meshes.push_back(box_of(vec3(3, 0, -10.0f * i - 2), vec3(5, 4, -10.0f * i)));
    Stage stage(std::move(meshes), {vec3(-40, 0, -200), vec3(40, 10, 10)});
    stage.view.camera = look_at({0, 1.7f, 8}, {0, 1.7f, -100}, {0, 1, 0}, 0.8f);
    stage.view.size = {160, 90};
    return stage;
}

TEST(ShadowMap, CascadesGetCoarserAndCoverTheView) {
    const Stage stage = street();
    const Light light = light_of(LightKind::sun, vec3(0), {-1, -0.6f, -0.2f});
    const ShadowMap map = stage.map(light, {512, 4, 1, 0});
    ASSERT_GE(map.images.size(), 3u);
    const float near = texel_size(map, {0, 1, 6}), far = texel_size(map, {0, 1, -190});
    EXPECT_GT(near, 0);
    EXPECT_LT(near, 0.5f * far);
    // All fog in view that anything can shade lies in a picture.
    const Box casters = stage.snapshot.occluders->bounds();
    for (uint32_t i = 0; i < 2000; ++i) {
        const vec2 pixel(random_unit(i, 0, 0, 2) * 160, random_unit(i, 0, 1, 2) * 90);
        const Ray ray = camera_ray(stage.view.camera, stage.view.size, pixel);
        const Interval<float> fog =
            clip(stage.snapshot.media[0].world_bounds, ray.origin, ray.direction, {0, infinity});
        const vec3 point = ray.at(glm::mix(fog.low, fog.high, random_unit(i, 0, 2, 2)));
        const bool shaded = !clip(casters, point, -light.direction, {0, infinity}).empty();
        if (!shaded) continue;
        EXPECT_GT(texel_size(map, point), 0) << point.x << " " << point.y << " " << point.z;
    }
}

TEST(ShadowMap, CascadesAgreeAtTheirBorders) {
    // Shadows by rays against shadows by maps, on a line away from the camera: away from edges by the coarsest texel
    // all cascades say the same as the ray.
    const Stage stage = street();
    const Light light = light_of(LightKind::sun, vec3(0), {-1, -0.6f, -0.2f});
    const ShadowMap map = stage.map(light, {512, 4, 1, 0});
    int same = 0, asked = 0;
    for (int i = 0; i < 4000; ++i) {
        const vec3 point(0.4f, 0.8f, 6 - 0.049f * static_cast<float>(i));
        const float around = 2 * texel_size(map, point);
        bool edge = false;
        float traced = stage.snapshot.occluders->transmission(Ray{point, -light.direction}, 0);
        for (uint32_t k = 0; k < 12; ++k)
            edge |= traced != stage.snapshot.occluders->transmission(
                                  Ray{point + around * random_direction(k, 8), -light.direction}, 0);
        if (edge) continue;
        ++asked, same += share_at(map, point) == traced;
    }
    EXPECT_GT(asked, 1000); // a quarter of the line
    EXPECT_EQ(same, asked);
}

TEST(ShadowMap, TexelsStayWhereTheyAreWhenTheCameraMoves) {
    // A small step of the camera: the same texel sizes, texels on the same lattice, so the same depths at the same
    // places.
    Stage stage = street();
    const Light light = light_of(LightKind::sun, vec3(0), {-1, -0.6f, -0.2f});
    const ShadowMap before = stage.map(light, {256, 2, 0, 0});
    stage.view.camera.position += vec3(0.01f, 0.005f, -0.02f);
    const ShadowMap after = stage.map(light, {256, 2, 0, 0});
    ASSERT_EQ(before.images.size(), after.images.size());
    for (size_t i = 0; i < before.images.size(); ++i)
        for (int axis = 0; axis < 2; ++axis) {
            ASSERT_EQ(before.images[i].scale[axis], after.images[i].scale[axis]);
            const float moved = after.images[i].offset[axis] - before.images[i].offset[axis];
            EXPECT_NEAR(moved, std::round(moved), 1e-3f);
        }
}

TEST(ShadowMap, OrbitSeesTheSameShadows) {
    // Catalog 24: wherever the camera stands, a point away from edges is lit or not as a ray says.
    Stage stage({box_of(vec3(-1, -1, -1), vec3(1, 0, 1)), quad({-6, -2, -6}, {12, 0, 0}, {0, 0, 12})});
    const Light light = light_of(LightKind::sun, vec3(0), {0.5f, -1, 0.2f});
    for (int degrees = 0; degrees < 360; degrees += 15) {
        const float turn = static_cast<float>(degrees) * pi / 180;
        stage.view.camera = look_at({9 * std::sin(turn), 2, 9 * std::cos(turn)}, {0, -1, 0}, {0, 1, 0}, 1);
        const ShadowMap map = stage.map(light, {256, 3, 1, 0});
        EXPECT_EQ(share_at(map, {0.4f, -1.5f, 0.2f}), 0) << degrees;
        EXPECT_EQ(share_at(map, {-1.7f, -1.5f, 0.2f}), 1) << degrees;
        EXPECT_EQ(share_at(map, {0, 0.5f, 0}), 1) << degrees;
    }
}

TEST(ShadowMap, GrazingSunIsFinite) {
    const Stage stage = street();
    for (const float elevation : {0.9f, 0.1f, 0.0f}) {
        const float a = elevation * pi / 180;
        const ShadowMap map =
            stage.map(light_of(LightKind::sun, vec3(0), {-std::cos(a), -std::sin(a), 0.01f}), {256, 3, 1, 0});
        for (const float depth : map.depth) ASSERT_FALSE(std::isnan(depth));
        EXPECT_EQ(share_at(map, {0, 2, -1}), 0) << "behind a block";
        EXPECT_EQ(share_at(map, {0, 2, -6}), 1) << "between two";
        EXPECT_EQ(share_at(map, {0, 6, -1}), 1) << "over them";
    }
}

TEST(ShadowMap, SameBitsOnAnyThreads) {
    const Stage stage = street();
    const Light light = light_of(LightKind::sun, vec3(0), {-1, -0.6f, -0.2f});
    const auto depths = [&] { return stage.map(light).depth; };
    EXPECT_EQ(on_threads(1, depths), on_threads(3, depths));
}

TEST(ShadowMap, LightsWithoutShadowsHaveNone) {
    const Stage stage({box_of(vec3(-1), vec3(1))});
    Light light = light_of(LightKind::sun, vec3(0), {0, -1, 0});
    light.shadows = false;
    EXPECT_TRUE(stage.map(light).empty());
    EXPECT_EQ(share_at(stage.map(light), {0, -2, 0}), 1);
}
}
}

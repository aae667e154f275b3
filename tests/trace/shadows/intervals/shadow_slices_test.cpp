// Lit stretches against hand-computed ones and against thousands of shadow rays.
#include "base/random.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/random_points.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/intervals/shadow_slices.h"
#include "trace/shadows/shadow_rays.h"
#include "trace/small_scenes.h"

#include "scene/camera.h"
#include "trace/moment.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
struct Stage {
    Scene scene;
    std::shared_ptr<const Occluders> occluders;
    ShadowSlices slices;

    void build(double seconds = 0) {
        occluders = Occluders::make(scene, seconds, nullptr);
        slices = make_shadow_slices(occluders->shadow_triangles());
    }
    std::vector<Interval<double>> lit(const Ray& ray, const LightPoint& light) const {
        std::vector<Interval<double>> result;
        find_lit(slices, ray, light, result);
        return result;
    }
};

Stage stage_of(std::vector<Mesh> meshes) {
    Stage stage;
    for (Mesh& mesh : meshes) add_mesh(stage.scene, std::move(mesh));
    stage.build();
    return stage;
}

void expect_lit(const std::vector<Interval<double>>& lit, const std::vector<Interval<double>>& expected,
                double tolerance = 1e-12) {
    ASSERT_EQ(lit.size(), expected.size());
    for (size_t i = 0; i < lit.size(); ++i) {
        EXPECT_NEAR(lit[i].low, expected[i].low, tolerance);
        EXPECT_NEAR(lit[i].high, expected[i].high, tolerance);
    }
}

// A horizontal square of half width 1 at height y = 1.
Mesh roof() { return quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}); }
const Ray level{{-4, 0, 0}, {1, 0, 0}, 8};

TEST(ShadowSlices, WithoutTrianglesEverythingIsLit) {
    expect_lit(Stage{}.lit(level, sun_from({0, 1, 0})), {{0, 8}});
    expect_lit(Stage{}.lit(level, lamp_at({0, 1, 0})), {{0, 8}});
}

TEST(ShadowSlices, SunShadowOfARoof) {
    const Stage stage = stage_of({roof()});
    expect_lit(stage.lit(level, sun_from({0, 1, 0})), {{0, 3}, {5, 8}});
    expect_lit(stage.lit(level, sun_from({1, 1, 0})), {{0, 2}, {4, 8}}); // 45°: shifted by the height
    expect_lit(stage.lit(level, sun_from({0, -1, 0})), {{0, 8}});        // from below: behind the ray
    expect_lit(stage.lit(level, sun_from({0, 1, 5})), {{0, 8}});         // passes beside
}

TEST(ShadowSlices, LampShadowOfARoof) {
    // A lamp at height h throws the edge at ±1 to ±h/(h-1).
    const Stage stage = stage_of({roof()});
    expect_lit(stage.lit(level, lamp_at({0, 2, 0})), {{0, 2}, {6, 8}});
    expect_lit(stage.lit(level, lamp_at({0, 5, 0})), {{0, 4 - 1.25}, {4 + 1.25, 8}});
    expect_lit(stage.lit(level, lamp_at({0, 0.9f, 0})), {{0, 8}}); // under the roof
    expect_lit(stage.lit(level, lamp_at({0, -3, 0})), {{0, 8}});
    // At height 1.25 from x = 0.5: the right edge to 0.5 + 5·0.5 = 3, the left one to 0.5 - 5·1.5 = -7.
    expect_lit(stage.lit(level, lamp_at({0.5f, 1.25f, 0})), {{7, 8}});
    expect_lit(stage.lit({{4, 0, 0}, {-1, 0, 0}, 8}, lamp_at({0.5f, 1.25f, 0})), {{0, 1}});
}

TEST(ShadowSlices, LightGetsThroughHolesExactly) {
    // Two roofs with a slit of a tenth of a millimeter: x from 0.25 on.
    const float slit = 1e-4f;
    const Stage stage =
        stage_of({quad({-1, 1, -1}, {1.25f, 0, 0}, {0, 0, 2}), quad({0.25f + slit, 1, -1}, {1, 0, 0}, {0, 0, 2})});
    const double from = 0.25, to = double(0.25f + slit), end = double(0.25f + slit + 1.0f);
    expect_lit(stage.lit(level, sun_from({0, 1, 0})), {{0, 3}, {4 + from, 4 + to}, {4 + end, 8}});
}

TEST(ShadowSlices, DuplicatedFlippedAndCoplanarFacesChangeNothing) {
    Mesh flipped = roof();
    for (glm::uvec3& corners : flipped.triangles) std::swap(corners.x, corners.y);
    const Stage stage = stage_of({roof(), roof(), flipped, quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}),
                                  quad({-1, 1, 0}, {2, 0, 0}, {0, 0.5f, 0})}); // the last one in the plane
    expect_lit(stage.lit(level, sun_from({0, 1, 0})), {{0, 3}, {5, 8}});
    expect_lit(stage.lit(level, lamp_at({0, 2, 0})), {{0, 2}, {6, 8}});
}

TEST(ShadowSlices, LightOnTheLineOfTheRay) {
    // A wall across the ray at x = 1, five meters along it.
    const Stage stage = stage_of({quad({1, -1, -1}, {0, 2, 0}, {0, 0, 2})});
    expect_lit(stage.lit(level, sun_from({1, 0, 0})), {{5, 8}}, 1e-6);  // ahead: the wall shadows what is before it
    expect_lit(stage.lit(level, sun_from({-1, 0, 0})), {{0, 5}}, 1e-6); // behind
    expect_lit(stage.lit(level, lamp_at({3, 0, 0})), {{5, 8}}, 1e-6);   // ahead, beyond the wall
    expect_lit(stage.lit(level, lamp_at({0, 0, 0})), {{0, 5}}, 1e-6);   // on the ray, before the wall
    expect_lit(stage.lit(level, lamp_at({-4, 0, 0})), {{0, 5}}, 1e-6);  // in the eye
    expect_lit(stage.lit(level, lamp_at({-6, 0, 0})), {{0, 5}}, 1e-6);  // behind the eye
    expect_lit(stage.lit(level, lamp_at({-6, 1e-12f, 0})), {{0, 5}}, 1e-6);
}

TEST(ShadowSlices, LightAlmostOnTheLineOfTheRay) {
    // A sill of height h across the ray at x = 1, seen under h/2 per meter: it shadows two meters.
    for (const float h : {1e-2f, 1e-4f, 1e-6f, 1e-7f}) {
        const Stage stage = stage_of({quad({1, -1, -1}, {0, 1, 0}, {0, 0, 2}), quad({1, 0, -1}, {0, h, 0}, {0, 0, 2})});
        expect_lit(stage.lit(level, sun_from({1, h / 2, 0})), {{0, 3}, {5, 8}}, 1e-5);
        expect_lit(stage.lit(level, sun_from({-1, h / 2, 0})), {{0, 5}, {7, 8}}, 1e-5);
        // A lamp four meters on at height 2h looks over the sill as far as 4 meters before it.
        expect_lit(stage.lit(level, lamp_at({5, 2 * h, 0})), {{0, 1}, {5, 8}}, 1e-5);
    }
}

TEST(ShadowSlices, ASurfaceDoesNotShadowTheRayThatEndsOnIt) {
    const Stage stage = stage_of({quad({-10, 0, -10}, {20, 0, 0}, {0, 0, 20})});
    for (int i = 0; i < 1000; ++i) {
        const vec3 origin = random_point(i, 3, {vec3(-4, 0.1f, -4), vec3(4, 3, 4)});
        vec3 direction = random_direction(i, 4);
        direction.y = -std::abs(direction.y) - 0.02f;
        direction = glm::normalize(direction);
        Hits hits;
        const Ray ray{origin, direction};
        stage.occluders->closest({&ray, 1}, 0, hits);
        if (hits.instance[0] < 0) continue;
        const std::vector<Interval<double>> lit = stage.lit({origin, direction, hits.t[0]}, sun_from({0.3f, 1, 0.2f}));
        ASSERT_EQ(lit.size(), 1u);
        EXPECT_EQ(lit[0].low, 0);
        // The float end of the ray may lie an ulp of its coordinates under the floor; seen flat that is longer.
        EXPECT_NEAR(lit[0].high, hits.t[0], 2e-6 / -direction.y);
    }
}

TEST(ShadowSlices, AClosedBoxLetsNothingIn) {
    // Walls of many small triangles, so that rays and planes meet their edges and corners.
    std::vector<Mesh> walls;
    constexpr int n = 8;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            Mesh wall;
            for (int i = 0; i <= n; ++i)
                for (int j = 0; j <= n; ++j) {
                    vec3 p(side);
                    p[(axis + 1) % 3] = -1 + 2.0f * i / n, p[(axis + 2) % 3] = -1 + 2.0f * j / n;
                    wall.positions.push_back(p);
                }
            for (uint32_t i = 0; i < n; ++i)
                for (uint32_t j = 0; j < n; ++j) {
                    const uint32_t a = i * (n + 1) + j;
                    wall.triangles.push_back({a, a + 1, a + n + 2});
                    wall.triangles.push_back({a, a + n + 2, a + n + 1});
                }
            walls.push_back(std::move(wall));
        }
    const Stage stage = stage_of(std::move(walls));
    const Box inside{vec3(-0.99f), vec3(0.99f)};
    for (int i = 0; i < 4000; ++i) {
        vec3 origin = random_point(i, 5, inside), target = random_point(i, 6, inside);
        if (i % 4 == 0) origin = glm::round(origin * 4.0f) / 4.0f * 0.7f, target = -origin + vec3(0, 0, 0.25f);
        const Ray ray{origin, glm::normalize(target - origin), glm::length(target - origin)};
        const vec3 light = i % 3 == 0 ? glm::round(3.0f * random_direction(i, 7)) : 3.0f * random_direction(i, 7);
        if (max_component(glm::abs(light)) < 1.5f) continue;
        EXPECT_TRUE(stage.lit(ray, sun_from(light)).empty()) << i;
        EXPECT_TRUE(stage.lit(ray, lamp_at(light)).empty()) << i;
    }
}

TEST(ShadowSlices, WhatLiesInTheLightsBallCastsNoShadow) {
    // The roof is 1 m under the lamp's center: inside a ball of 1.5 m, outside one of 0.5 m.
    const Stage stage = stage_of({quad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1})});
    expect_lit(stage.lit(level, lamp_at({0, 2, 0}, 0.5)), {{0, 3}, {5, 8}});
    expect_lit(stage.lit(level, lamp_at({0, 2, 0}, 1.5)), {{0, 8}});
    // A ball that reaches the ray lights it inside, whatever else stands about.
    expect_lit(stage.lit(level, lamp_at({0, 0.3f, 0}, 0.5)), {{0, 8}});
    const Stage wide = stage_of({quad({-9, 0.05f, -9}, {18, 0, 0}, {0, 0, 18})});
    const double lamp = 0.3f, above = lamp - double(0.05f); // its edge in the ball is thrown on from there
    const double reach = std::sqrt(0.25 - above * above) * lamp / above;
    expect_lit(wide.lit(level, lamp_at({0, 0.3f, 0}, 0.5)), {{4 - reach, 4 + reach}});
}

TEST(ShadowSlices, TrianglesWithAlphaAreLeftToShadowRays) {
    Scene scene;
    scene.materials = {blend_material(0.5f), blend_material(1), Material{}};
    scene.materials[2].alpha_mode = AlphaMode::mask;
    for (int material = -1; material < 3; ++material) {
        Mesh mesh = roof();
        mesh.material = material;
        add_mesh(scene, mesh);
    }
    const auto triangles = Occluders::make(scene, 0, nullptr)->shadow_triangles();
    ASSERT_EQ(triangles.size(), 8u);
    const bool expected[] = {false, true, false, true}; // a sheet of alpha 1 without a texture is opaque
    for (size_t i = 0; i < 8; ++i) EXPECT_EQ(triangles[i].has_alpha, expected[i / 2]) << i;
    EXPECT_EQ(make_shadow_slices(triangles).triangles(), 4u);
}

TEST(ShadowSlices, TrianglesThatEmbreeLeavesOutAreLeftOut) {
    Mesh bad = roof();
    bad.positions[3] = bad.positions[2]; // the second triangle has no area
    Mesh worse = bad;
    worse.positions[1] = worse.positions[2]; // neither has the first
    EXPECT_EQ(stage_of({bad, worse}).slices.triangles(), 1u);
}

// Probes along random rays on which slices and shadow rays disagree further than `near` from an end.
struct Agreement {
    int probes = 0, shadowed = 0, wrong = 0;
    double worst = 0; // distance of a disagreeing probe from the nearest end
};

void compare(const Stage& stage, const Ray& ray, const LightPoint& light, int count, double near, Agreement& sum) {
    const std::vector<Interval<double>> lit = stage.lit(ray, light);
    for (int first = 0; first < count; first += 16) {
        Occluders::ShadowRays rays;
        double at[16];
        for (int i = 0; i < 16; ++i) {
            at[i] = ray.t_max * (first + i + 0.5) / count;
            const vec3 point(dvec3(ray.origin) + at[i] * dvec3(ray.direction));
            const dvec3 towards = light.far ? light.at : light.at - dvec3(point);
            const float end = light.far ? infinity : 0.9999f * static_cast<float>(glm::length(towards));
            set_ray(rays, i, point, vec3(glm::normalize(towards)), end);
        }
        float visible[16];
        stage.occluders->transmission(rays, visible);
        for (int i = 0; i < 16; ++i) {
            bool inside = false;
            double end = std::numeric_limits<double>::infinity();
            for (const Interval<double>& stretch : lit) {
                inside = inside || (at[i] > stretch.low && at[i] < stretch.high);
                end = std::min({end, std::abs(at[i] - stretch.low), std::abs(at[i] - stretch.high)});
            }
            ++sum.probes, sum.shadowed += visible[i] == 0;
            if (inside == (visible[i] > 0.5f)) continue;
            sum.worst = std::max(sum.worst, end);
            sum.wrong += end > near;
        }
    }
}

Mesh soup(int triangles, uint32_t seed, float size) {
    Mesh mesh;
    const Box box{vec3(-1), vec3(1)};
    for (int i = 0; i < triangles; ++i) {
        const vec3 middle = random_point(i, seed, box);
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + size * random_direction(3 * i + k, seed + 1));
        const uint32_t first = 3 * i;
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TEST(ShadowSlices, AgreeWithShadowRaysInRandomSoups) {
    for (const auto& [count, size] : {std::pair(12, 0.9f), std::pair(300, 0.25f), std::pair(4000, 0.05f)}) {
        const Stage stage = stage_of({soup(count, 100 + count, size)});
        Agreement sum;
        for (int i = 0; i < 120; ++i) {
            const Box box{vec3(-1.5f), vec3(1.5f)};
            const vec3 from = random_point(i, 11, box), to = random_point(i, 12, box);
            const Ray ray{from, glm::normalize(to - from), glm::length(to - from)};
            const LightPoint light =
                i % 2 ? sun_from(random_direction(i, 13)) : lamp_at(2.0f * random_point(i, 14, {vec3(-1), vec3(1)}));
            compare(stage, ray, light, 2048, 1e-5, sum);
        }
        EXPECT_EQ(sum.wrong, 0) << count << " triangles, worst " << sum.worst;
        EXPECT_GT(sum.shadowed, sum.probes / 10);
        EXPECT_LT(sum.shadowed, sum.probes * 9 / 10);
    }
}

// Bundles of rays of one origin, each with a point of its own of the light.
TEST(ShadowSlices, LeavesNearSomeRaysAnswerAsAllDo) {
    const Stage stage = stage_of({soup(4000, 7, 0.05f)});
    const Box box{vec3(-1.5f), vec3(1.5f)};
    const size_t leaves = std::ranges::count_if(stage.slices.nodes, [](const auto& node) { return node.count > 0; });
    for (const float spread : {0.0f, 0.02f, 0.3f, 3.0f}) {
        size_t kept = 0;
        for (int i = 0; i < 60; ++i) {
            const vec3 origin = random_point(i, 31, box), ahead = random_direction(i, 32);
            const LightPoint light = i % 2 ? sun_from(random_direction(i, 33)) : lamp_at(random_point(i, 34, box));
            std::vector<Ray> rays;
            std::vector<LightPoint> points;
            for (int k = 0; k < 16; ++k) {
                const vec3 aside = spread * random_point(16 * i + k, 35, {vec3(-1), vec3(1)});
                rays.push_back({origin, glm::normalize(ahead + aside), i % 5 ? 0.1f + 0.2f * k : infinity});
                points.push_back(light);
                points.back().at += 0.1 * dvec3(aside);
                if (light.far) points.back().at = glm::normalize(points.back().at);
            }
            const ShadowSlices near = coherent_slices(stage.slices, rays, points);
            kept += near.nodes.size();
            for (size_t k = 0; k < 16; ++k) {
                std::vector<Interval<double>> lit;
                find_lit(near, rays[k], points[k], lit);
                expect_lit(lit, stage.lit(rays[k], points[k]), 0);
            }
        }
        EXPECT_LT(kept, 60 * leaves / (spread < 0.1f ? 4 : 1)) << spread;
    }
}

TEST(ShadowSlices, AgreeWithShadowRaysInTheExampleScenes) {
    for (const char* name : {"window", "spotlight", "pillars", "lantern", "concert"}) {
        Stage stage;
        stage.scene = load_scene(std::filesystem::path(TYNDALL_SOURCE_DIR) / "scenes" / (std::string(name) + ".json"));
        stage.build(0.5);
        const Camera camera = camera_at(stage.scene, stage.scene.camera, 0.5);
        const double scene_size = glm::length(stage.occluders->bounds().size());
        Agreement sum;
        for (int i = 0; i < 200; ++i) {
            const vec2 at(320 * random_unit(i, 0, 0, 21), 180 * random_unit(i, 0, 1, 21));
            Ray ray = camera_ray(camera, {320, 180}, at);
            Hits hits;
            stage.occluders->closest({&ray, 1}, 0, hits);
            ray.t_max = std::min(hits.t[0], static_cast<float>(scene_size)) * 0.999f;
            const LightSource& source = stage.scene.lights[i % stage.scene.lights.size()];
            const LightPoint light =
                is_distant(source) ? sun_from(-source.direction.at(0.5)) : lamp_at(source.position.at(0.5));
            compare(stage, ray, light, 1024, 1e-5 * scene_size, sum);
        }
        EXPECT_EQ(sum.wrong, 0) << name << ", worst " << sum.worst << " of " << scene_size;
        EXPECT_GT(sum.shadowed, sum.probes / 50);
        EXPECT_LT(sum.shadowed, sum.probes * 49 / 50);
    }
}
}
}

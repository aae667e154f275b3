
#include "base/error.h"
#include "base/parallel.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/meshes.h"
#include "support/random_points.h"
#include "support/threads.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/shadow_rays.h"
#include "trace/small_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace tyndall {
namespace {
using namespace test;

std::shared_ptr<const Occluders> occluders_of(const Scene& scene, double seconds = 0) {
    return Occluders::make(scene, seconds, nullptr);
}

Node moving_node() {
    Node node;
    node.translation.times = {0, 1};
    node.translation.values = {vec3(0), vec3(10, 0, 0)};
    return node;
}

TEST(Occluders, BoxShadowsExactlyThePointsBehindIt) {
    Scene scene;
    add_mesh(scene, box_of(vec3(-1), vec3(1)));
    const auto occluders = occluders_of(scene);
    EXPECT_EQ(occluders->triangle_count(), 12u);
    EXPECT_EQ(occluders->bounds().low, vec3(-1));
    EXPECT_EQ(occluders->bounds().high, vec3(1));

    // Light from +y: a point below the box is dark when its x and z lie within the box.
    for (uint32_t packet = 0; packet < 64; ++packet) {
        Occluders::ShadowRays rays;
        vec3 points[16];
        for (int lane = 0; lane < 16; ++lane) {
            points[lane] = random_point(packet * 16 + lane, 1, {vec3(-2, -3, -2), vec3(2, -2, 2)});
            set_ray(rays, lane, points[lane], vec3(0, 1, 0));
        }
        float visibility[16];
        occluders->transmission(rays, visibility);
        for (int lane = 0; lane < 16; ++lane) {
            const bool dark = std::abs(points[lane].x) < 1 && std::abs(points[lane].z) < 1;
            EXPECT_EQ(visibility[lane], dark ? 0.0f : 1.0f) << points[lane].x << " " << points[lane].z;
            EXPECT_EQ(occluders->transmission({points[lane], vec3(0, 1, 0)}, 0), visibility[lane]);
        }
    }
}

TEST(Occluders, RaysEndAtTheLightAndStartBeyondTheirOffset) {
    Scene scene;
    add_mesh(scene, quad(vec3(-1, 1, -1), vec3(2, 0, 0), vec3(0, 0, 2)));
    const auto occluders = occluders_of(scene);
    Occluders::ShadowRays rays;
    set_ray(rays, -1, vec3(0.1f, 0, 0.2f), vec3(0, 1, 0));
    rays.t_max[0] = 0.9f, rays.t_max[1] = 1.1f;
    rays.t_min[2] = 1.1f;
    rays.t_max[3] = 0;
    rays.active[4] = 0;
    float visibility[16] = {};
    visibility[4] = 0.25f;
    occluders->transmission(rays, visibility);
    EXPECT_EQ(visibility[0], 1);
    EXPECT_EQ(visibility[1], 0);
    EXPECT_EQ(visibility[2], 1);
    EXPECT_EQ(visibility[3], 1);
    EXPECT_EQ(visibility[4], 0.25f);
    EXPECT_EQ(visibility[5], 0);
}

TEST(Occluders, ClosestFindsTheNearerOfStillAndMoving) {
    Scene scene;
    add_mesh(scene, quad(vec3(-1, -1, -3), vec3(2, 0, 0), vec3(0, 2, 0)));
    add_mesh(scene, quad(vec3(-1, -1, -2), vec3(2, 0, 0), vec3(0, 2, 0)), moving_node());
    const Ray straight{vec3(0.25f, 0.5f, 0), vec3(0, 0, -1)}, aside{vec3(0.25f, 0.5f, 0), vec3(0, 0, 1)};
    Ray rays[20];
    for (Ray& ray : rays) ray = straight;
    rays[3] = aside;
    rays[4].t_max = 1;

    Hits hits;
    occluders_of(scene)->closest({rays, 16}, 0, hits);
    EXPECT_EQ(hits.instance[0], 1);
    EXPECT_FLOAT_EQ(hits.t[0], 2);
    EXPECT_EQ(hits.instance[3], -1);
    EXPECT_EQ(hits.t[3], infinity);
    EXPECT_EQ(hits.instance[4], -1);

    const auto later = occluders_of(scene, 1);
    later->closest({rays, 3}, 0, hits, false);
    EXPECT_EQ(hits.instance[0], 0);
    EXPECT_FLOAT_EQ(hits.t[0], 3);
    EXPECT_EQ(hits.instance[3], -1);
    const SurfacePoint point = later->surface(straight, hits, 0);
    EXPECT_NEAR(point.position.z, -3, 1e-6);
    EXPECT_NEAR(point.position.x, 0.25f, 1e-6);
    EXPECT_EQ(point.face_normal, vec3(0, 0, 1));
    EXPECT_EQ(point.normal, vec3(0, 0, 1));
    EXPECT_EQ(point.alpha, 1);
}

TEST(Occluders, ShadingNormalsFollowTheInverseTranspose) {
    Mesh mesh = quad(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
    mesh.normals.assign(4, glm::normalize(vec3(1, 0, 1)));
    mesh.colors.assign(4, vec3(0.5f, 1, 1));
    Scene scene;
    Node node;
    node.scale = vec3(2, 1, 1);
    mesh.material = 0;
    Material material;
    material.base_color = vec3(1, 0.5f, 1);
    material.emission = vec3(3);
    scene.materials = {material};
    add_mesh(scene, mesh, node);
    const auto occluders = occluders_of(scene);
    for (const float side : {1.0f, -1.0f}) {
        const Ray ray{vec3(0.2f, 0.1f, 5 * side), vec3(0, 0, -side)};
        Hits hits;
        occluders->closest({&ray, 1}, 0, hits);
        ASSERT_EQ(hits.instance[0], 0);
        const SurfacePoint point = occluders->surface(ray, hits, 0);
        const vec3 expected = side * glm::normalize(vec3(0.5f, 0, 1));
        EXPECT_NEAR(glm::distance(point.normal, expected), 0, 1e-6);
        EXPECT_NEAR(glm::distance(point.face_normal, vec3(0, 0, side)), 0, 1e-6);
        EXPECT_NEAR(glm::distance(point.base_color, vec3(0.5f, 0.5f, 1)), 0, 1e-6);
        EXPECT_EQ(point.emission, vec3(3));
    }
}

TEST(Occluders, BadTrianglesAreLeftOutAndCounted) {
    Scene scene;
    Mesh mesh = quad(vec3(-1, -1, -1), vec3(2, 0, 0), vec3(0, 2, 0));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.positions.insert(mesh.positions.end(), {vec3(nan, 0, 0), vec3(0, infinity, 0), vec3(0, 0, 1e19f)});
    mesh.triangles = {{0, 1, 4}, {0, 1, 5}, {0, 1, 2}, {0, 1, 6}, {0, 1, 1}, {0, 1, 99}, {0, 2, 3}};
    add_mesh(scene, mesh);
    const auto occluders = occluders_of(scene);
    EXPECT_EQ(occluders->triangle_count(), 2u);
    EXPECT_EQ(occluders->dropped(), 5u);
    EXPECT_EQ(occluders->bounds().high, vec3(1, 1, -1));
    const Ray ray{vec3(-0.5f, 0.5f, 0), vec3(0, 0, -1)};
    Hits hits;
    occluders->closest({&ray, 1}, 0, hits);
    EXPECT_EQ(hits.triangle[0], 6);
    EXPECT_NEAR(occluders->surface(ray, hits, 0).position.x, -0.5f, 1e-6);
}

TEST(Occluders, NothingButBadTrianglesIsEmpty) {
    Scene scene;
    Mesh mesh = quad(vec3(0), vec3(1, 0, 0), vec3(2, 0, 0));
    add_mesh(scene, mesh);
    const auto occluders = occluders_of(scene);
    EXPECT_TRUE(occluders->empty());
    EXPECT_EQ(occluders->dropped(), 2u);
    Occluders::ShadowRays rays;
    set_ray(rays, -1, vec3(0), vec3(0, 1, 0));
    float visibility[16] = {};
    occluders->transmission(rays, visibility);
    EXPECT_EQ(visibility[7], 1);
}

// The packaged Embree aborts on such rays: they must never reach it.
TEST(Occluders, UnfitRaysHitNothingAndAreBlocked) {
    Scene scene;
    add_mesh(scene, box_of(vec3(-1), vec3(1)));
    const auto occluders = occluders_of(scene);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Ray unfit[] = {{vec3(nan, 0, 5), vec3(0, 0, -1)},       {vec3(0, 0, 5), vec3(0, nan, -1)},
                         {vec3(infinity, 0, 5), vec3(0, 0, -1)},  {vec3(0, 0, 5), vec3(0, 0, -infinity)},
                         {vec3(0, 0, 2e18f), vec3(0, 0, -1)},     {vec3(0, 0, 5), vec3(0, 0, -1), nan},
                         {vec3(0, -1e30f, 0), vec3(0, 0, -1), 1}, {vec3(0, 0, 5), vec3(2e18f, 0, -1)}};
    constexpr size_t count = std::size(unfit);
    Hits hits;
    occluders->closest(unfit, 0, hits);
    Occluders::ShadowRays rays;
    set_ray(rays, -1, vec3(5, 0, 0), vec3(0, 1, 0));
    for (size_t i = 0; i < count; ++i)
        set_ray(rays, static_cast<int>(i), unfit[i].origin, unfit[i].direction, unfit[i].t_max);
    rays.t_min[count] = nan, rays.t_min[count + 1] = -1, rays.t_min[count + 2] = infinity;
    float visibility[16];
    std::fill_n(visibility, 16, 0.5f);
    occluders->transmission(rays, visibility);
    for (size_t i = 0; i < count; ++i) {
        EXPECT_EQ(hits.instance[i], -1) << i;
        EXPECT_EQ(visibility[i], 0) << i;
        EXPECT_EQ(occluders->transmission(unfit[i], 0), 0) << i;
    }
    for (size_t i = count; i < count + 3; ++i) EXPECT_EQ(visibility[i], 0) << i;
    EXPECT_EQ(visibility[15], 1);
}

TEST(Occluders, ClosedBoxHasNoLeaks) {
    Scene scene;
    const Box box{vec3(99.3f, -0.2f, 7.1f), vec3(101.7f, 1.9f, 8.4f)};
    add_mesh(scene, box_of(box.low, box.high));
    const auto occluders = occluders_of(scene);
    int leaks = 0;
    for (uint32_t packet = 0; packet < 6250; ++packet) {
        Occluders::ShadowRays rays;
        for (uint32_t lane = 0; lane < 16; ++lane) {
            const uint32_t index = packet * 16 + lane;
            // A quarter of the rays aims at edges and corners.
            const vec3 from = random_point(index, 2, box);
            vec3 to = from + random_direction(index, 3);
            if (index % 4 == 0) to = vec3(index & 4 ? box.low.x : box.high.x, index & 8 ? box.low.y : box.high.y, to.z);
            if (index % 8 == 0) to.z = index & 16 ? box.low.z : box.high.z;
            set_ray(rays, static_cast<int>(lane), from, glm::normalize(to - from));
        }
        float visibility[16];
        occluders->transmission(rays, visibility);
        for (const float v : visibility) leaks += v > 0;
    }
    EXPECT_EQ(leaks, 0);
}

TEST(Occluders, RaysFromASurfaceMissItAtTheShadowOffset) {
    for (const float size : {0.01f, 1.0f, 300.0f}) {
        Scene scene;
        add_mesh(scene, box_of(vec3(size, 0.3f * size, -size), vec3(2.3f * size, 1.7f * size, 0.7f * size)));
        const auto occluders = occluders_of(scene);
        const vec3 center(1.6f * size, size, -0.1f * size);
        int blocked = 0;
        for (uint32_t i = 0; i < 4000; ++i) {
            const vec3 direction = random_direction(i, 5);
            const Ray ray{center + 6 * size * direction, -direction};
            Hits hits;
            occluders->closest({&ray, 1}, 0, hits);
            ASSERT_EQ(hits.instance[0], 0);
            const SurfacePoint point = occluders->surface(ray, hits, 0);
            const vec3 away = glm::normalize(point.face_normal + 0.999f * random_direction(i, 6));
            const vec3 origin = point.position + shadow_offset(point.position) * point.face_normal;
            blocked += occluders->transmission({origin, away}, 0) < 1;
        }
        EXPECT_EQ(blocked, 0) << size;
    }
}

TEST(Occluders, WhatDoesNotMoveIsShared) {
    Scene scene;
    add_mesh(scene, box_of(vec3(-1), vec3(1)));
    const auto first = Occluders::make(scene, 0, nullptr);
    EXPECT_TRUE(Occluders::make(scene, 1, first.get())->shares_with(*first));
    EXPECT_FALSE(Occluders::make(scene, 1, nullptr)->shares_with(*first));

    add_mesh(scene, box_of(vec3(4), vec3(5)), moving_node());
    const auto start = Occluders::make(scene, 0, nullptr);
    const auto same_time = Occluders::make(scene, 0, start.get());
    const auto later = Occluders::make(scene, 0.5, start.get());
    EXPECT_TRUE(same_time->shares_with(*start));
    EXPECT_FALSE(later->shares_with(*start));
    EXPECT_EQ(start->bounds().high.x, 5);
    EXPECT_EQ(later->bounds().high.x, 10);
    EXPECT_EQ(later->triangle_count(), 24u);
    // Held at the last key: nothing moves any more.
    const auto held = Occluders::make(scene, 2, later.get());
    EXPECT_TRUE(Occluders::make(scene, 3, held.get())->shares_with(*held));
}

// A soup of triangles, many of them twice, some transparent.
Scene soup() {
    Scene scene;
    scene.materials = {blend_material(0.3f), Material{}};
    for (int material = 0; material < 2; ++material) {
        Mesh mesh;
        mesh.material = material;
        for (uint32_t i = 0; i < (material ? 2000u : 6000u); ++i) {
            const vec3 at = random_point(i, 7 + static_cast<uint32_t>(material), {vec3(-5), vec3(5)});
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            for (uint32_t k = 0; k < 3; ++k) mesh.positions.push_back(at + 0.3f * random_direction(3 * i + k, 9));
            for (int copy = 0; copy < 1 + (i % 3 == 0); ++copy) mesh.triangles.push_back({first, first + 1, first + 2});
        }
        add_mesh(scene, mesh);
    }
    return scene;
}

std::vector<uint32_t> answers(const Scene& scene) {
    const auto occluders = occluders_of(scene);
    std::vector<uint32_t> bits;
    for (uint32_t packet = 0; packet < 500; ++packet) {
        Occluders::ShadowRays shadows;
        Ray rays[16];
        for (uint32_t lane = 0; lane < 16; ++lane) {
            const uint32_t index = packet * 16 + lane;
            rays[lane] = {random_point(index, 11, {vec3(-6), vec3(6)}), random_direction(index, 12)};
            set_ray(shadows, static_cast<int>(lane), rays[lane].origin, rays[lane].direction);
        }
        float visibility[16];
        occluders->transmission(shadows, visibility);
        Hits hits;
        occluders->closest(rays, 0, hits);
        for (int lane = 0; lane < 16; ++lane) {
            uint32_t words[2];
            std::memcpy(&words[0], &visibility[lane], 4), std::memcpy(&words[1], &hits.t[lane], 4);
            bits.insert(bits.end(), {words[0], words[1], static_cast<uint32_t>(hits.instance[lane]),
                                     static_cast<uint32_t>(hits.triangle[lane])});
        }
    }
    return bits;
}

TEST(Occluders, SameBitsAtAnyThreadCount) {
    const Scene scene = soup();
    const auto asked = [&] { return answers(scene); };
    const auto one = on_threads(1, asked);
    EXPECT_EQ(on_threads(2, asked), one);
    EXPECT_EQ(on_threads(4, asked), one);
}

// Embree's own thread setting would limit the whole process.
TEST(Occluders, TheRayTracerLeavesThreadsAlone) {
    const Threads three(3);
    Scene scene;
    add_mesh(scene, box_of(vec3(-1), vec3(1)));
    occluders_of(scene);
    EXPECT_EQ(thread_count(), 3);
}

TEST(Occluders, InstructionSetIsFixedOnceUsed) {
    Scene scene;
    add_mesh(scene, box_of(vec3(-1), vec3(1)));
    occluders_of(scene);
    EXPECT_NO_THROW(set_embree_isa("auto"));
    EXPECT_NO_THROW(set_embree_isa("avx2"));
    EXPECT_THROW(set_embree_isa("avx512"), Error);
    EXPECT_THROW(set_embree_isa("sse9"), Error);
}

// A forest that no machine holds: refused before any of it is made.
TEST(Occluders, MoreThanTheMemoryThereIs) {
    Scene scene;
    scene.file = "forest.json";
    add_mesh(scene, box_of(vec3(-1), vec3(1)));
    scene.meshes[0].triangles.resize(2000000, glm::uvec3(0, 1, 2));
    scene.instances.assign(100000, scene.instances[0]);
    EXPECT_THAT(error_message(ExitCode::out_of_memory, [&] { occluders_of(scene); }),
                testing::StartsWith("forest.json: 200000000000 triangles in 100000 instances take about "));
}

TEST(Occluders, MeshesThatChangeTheirShapeAreBuiltAnew) {
    Scene scene;
    Mesh mesh = quad(vec3(-1, -1, -2), vec3(2, 0, 0), vec3(0, 2, 0));
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.targets.push_back({std::vector<vec3>(4, vec3(0, 0, -4)), std::vector<vec3>(4, vec3(1, 0, 0))});
    add_mesh(scene, mesh);
    scene.instances[0].target_weights = {from_to(0.0f, 1.0f)};
    const auto start = Occluders::make(scene, 0, nullptr), middle = Occluders::make(scene, 0.5, start.get());
    EXPECT_FALSE(middle->shares_with(*start));
    EXPECT_NE(middle->content(), start->content());
    EXPECT_TRUE(Occluders::make(scene, 0.5, middle.get())->shares_with(*middle));

    const Ray ray{vec3(0.25f, 0.5f, 0), vec3(0, 0, -1)};
    Hits hits;
    start->closest({&ray, 1}, 0, hits);
    EXPECT_FLOAT_EQ(hits.t[0], 2);
    EXPECT_EQ(start->surface(ray, hits, 0).normal, vec3(0, 0, 1));
    middle->closest({&ray, 1}, 0, hits);
    EXPECT_FLOAT_EQ(hits.t[0], 4);
    EXPECT_LT(glm::distance(middle->surface(ray, hits, 0).normal, glm::normalize(vec3(0.5f, 0, 1))), 1e-6f);
    EXPECT_EQ(middle->bounds().low.z, -4);
}
}
}

#include "scene/light.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/run_mode.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/small_scenes.h"

#include "base/parallel.h"
#include "trace/frame_cache.h"
#include "trace/shadows/intervals/shadow_slices.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/recipe/recipe.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace tyndall {
namespace {
using namespace test;

Snapshot next_of(const Snapshot& before) {
    Snapshot next;
    next.cache = std::make_shared<FrameCache>(), next.previous_cache = before.cache;
    return next;
}

CacheKey number(int value) { return CacheKey().add(value); }

// A floor that stays, a box that may move, noise fog and a lamp whose brightness is animated.
Scene lamp_scene() {
    Scene scene;
    add_mesh(scene, quad({-3, 0, -3}, {6, 0, 0}, {0, 0, 6}));
    add_mesh(scene, box_of({-0.5f, 1, -0.5f}, {0.5f, 1.5f, 0.5f}), Node{});
    MediumSource fog;
    fog.name = "mist", fog.kind = MediumKind::noise;
    FogRecipe recipe;
    recipe.voxel_size = 0.2f, recipe.threshold = 0.4f;
    fog.recipe = recipe;
    scene.media = {fog};
    LightSource lamp;
    lamp.name = "lamp", lamp.kind = LightKind::spot;
    lamp.position = vec3(0, 3, 0), lamp.direction = vec3(0, -1, 0);
    lamp.intensity = from_to(10.0f, 20.0f);
    scene.lights = {lamp};
    return scene;
}

SharedFloats grid_of(const Snapshot& snapshot) {
    return make_light_depth(snapshot, snapshot.lights.at(0), LightTransmittance::grid, 16).grid.depth;
}

SharedFloats froxels_of(const Snapshot& snapshot, const View& view) {
    return make_light_depth(snapshot, snapshot.lights.at(0), LightTransmittance::froxel, 16, &view).froxels.depth;
}

TEST(CacheKey, ComparesBitsAndObjects) {
    EXPECT_EQ(CacheKey().add(1.0f).add(vec3(1, 2, 3)), CacheKey().add(1.0f).add(vec3(1, 2, 3)));
    EXPECT_NE(CacheKey().add(0.0f), CacheKey().add(-0.0f));
    EXPECT_EQ(CacheKey().add(NAN), CacheKey().add(NAN));
    EXPECT_NE(CacheKey().add(1), CacheKey().add(1.0));
    const auto a = std::make_shared<int>(1), b = std::make_shared<int>(1);
    EXPECT_EQ(CacheKey().add(a), CacheKey().add(std::shared_ptr<const int>(a)));
    EXPECT_NE(CacheKey().add(a), CacheKey().add(b));
    EXPECT_NE(CacheKey().add(a), CacheKey().add(a).add(b));
}

// Memory is handed out again; what lay there before must not be found.
TEST(CacheKey, TakesNoObjectForADeadOne) {
    for (int i = 0; i < 100; ++i) {
        auto first = std::make_shared<int>(1);
        const CacheKey key = CacheKey().add(first);
        first.reset();
        EXPECT_NE(key, CacheKey().add(std::make_shared<int>(1)));
    }
}

TEST(CacheKey, OfALightLeavesOutItsBrightness) {
    Light a, b;
    b.intensity = vec3(5), b.volume_scale = 2, b.surface_scale = 0, b.name = "other";
    EXPECT_EQ(CacheKey().add(a), CacheKey().add(b));
    const auto differs = [&](auto change) {
        Light changed = a;
        change(changed);
        return CacheKey().add(a) != CacheKey().add(changed);
    };
    EXPECT_TRUE(differs([](Light& l) { l.kind = LightKind::sun; }));
    EXPECT_TRUE(differs([](Light& l) { l.position.x = 1e-6f; }));
    EXPECT_TRUE(differs([](Light& l) { l.direction = vec3(1, 0, 0); }));
    EXPECT_TRUE(differs([](Light& l) { l.outer_cone = 0.1f; }));
    EXPECT_TRUE(differs([](Light& l) { l.radius = 0.1f; }));
    EXPECT_TRUE(differs([](Light& l) { l.angle = 0.1f; }));
    EXPECT_TRUE(differs([](Light& l) { l.shadows = false; }));
}

TEST(FrameCache, IsMadeOnceAndHandedOn) {
    int made = 0;
    const auto ask = [&](const Snapshot& snapshot, int key) {
        return cached(snapshot, "thing", number(key), [&] { return ++made; });
    };
    Snapshot frame = next_of({});
    const auto first = ask(frame, 7);
    EXPECT_EQ(ask(frame, 7), first);
    EXPECT_EQ(ask(frame, 8) == first, false);
    EXPECT_EQ(made, 2);
    for (int i = 0; i < 20; ++i) {
        frame = next_of(frame);
        EXPECT_EQ(ask(frame, 7), first);
    }
    EXPECT_EQ(made, 2);
    EXPECT_EQ(*ask(frame, 8), 3); // nobody asked for it in the frames between
}

TEST(FrameCache, TypesAreKeptApart) {
    const Snapshot frame = next_of({});
    EXPECT_EQ(*cached(frame, "thing", number(1), [] { return 1; }), 1);
    EXPECT_EQ(*cached(frame, "thing", number(1), [] { return 2.5; }), 2.5);
}

TEST(FrameCache, SnapshotsMadeByHandKeepNothing) {
    const Snapshot by_hand;
    int made = 0;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(*cached(by_hand, "thing", number(1), [&] { return ++made; }), i + 1);
}

TEST(FrameCache, ManyThreadsMakeItOnce) {
    const Snapshot first = next_of({});
    std::atomic<int> made = 0;
    for (const Snapshot& frame : {first, next_of(first)})
        parallel_for(1000, [&](int64_t i) {
            const int key = static_cast<int>(i % 7);
            EXPECT_EQ(*cached(frame, "thing", number(key), [&] { return ++made, key; }), key);
        });
    EXPECT_EQ(made, 7);
}

TEST(FrameCache, AnErrorIsNotKept) {
    const Snapshot frame = next_of({});
    bool works = false;
    const auto make = [&] { return works ? 1 : throw std::runtime_error("no"); };
    EXPECT_THROW(cached(frame, "thing", number(1), make), std::runtime_error);
    works = true;
    EXPECT_EQ(*cached(frame, "thing", number(1), make), 1);
}

// With all that changes from frame to frame, what two frames made is all there is.
TEST(FrameCache, MemoryDoesNotGrowWithFrames) {
    std::vector<std::weak_ptr<const std::vector<float>>> made;
    Snapshot frame;
    for (int i = 0; i < 50; ++i) {
        frame = next_of(frame);
        made.push_back(std::weak_ptr(cached(frame, "thing", number(i), [] { return std::vector<float>(1000); })));
        EXPECT_LE(frame.cache->entries.size(), 1u);
        for (int k = 0; k + 1 < i; ++k) EXPECT_TRUE(made[static_cast<size_t>(k)].expired()) << k << " in frame " << i;
    }
    EXPECT_FALSE(made.back().expired());
}

TEST(FrameCache, SurfacesThatStandStillAreSharedWithAllMadeOfThem) {
    Scene scene = lamp_scene();
    const Snapshot first = make_snapshot(scene, Moment{0, 0}), second = make_snapshot(scene, Moment{1, 0.5}, &first);
    EXPECT_EQ(second.occluders, first.occluders);
    EXPECT_EQ(&second.occluders->shadow_slices(), &first.occluders->shadow_slices());
    EXPECT_EQ(second.occluders->shadow_mesh(), first.occluders->shadow_mesh());
    EXPECT_EQ(first.occluders->shadow_slices().triangles(), 14u);
    EXPECT_EQ(first.occluders->shadow_mesh()->triangles.size(), 14u);

    scene.nodes[0].translation = from_to(vec3(0), vec3(1, 0, 0));
    const Snapshot start = make_snapshot(scene, Moment{0, 0}), end = make_snapshot(scene, Moment{1, 1}, &start);
    EXPECT_NE(end.occluders, start.occluders);
    EXPECT_NE(end.occluders->shadow_mesh()->corners, start.occluders->shadow_mesh()->corners);
    EXPECT_EQ(make_snapshot(scene, Moment{2, 1}, &end).occluders, end.occluders);
}

TEST(FrameCache, LightDepthIsMadeOnceForFramesAndUsers) {
    Scene scene = lamp_scene();
    const View view = view_of({4, 2, 4}, {0, 1, 0}, {64, 48});
    const Snapshot first = make_snapshot(scene, Moment{0, 0}), second = make_snapshot(scene, Moment{1, 0.5}, &first);
    ASSERT_EQ(first.lights.size(), 1u);
    EXPECT_NE(first.lights[0].intensity, second.lights[0].intensity);
    const SharedFloats grid = grid_of(first), froxels = froxels_of(first, view);
    ASSERT_TRUE(grid && froxels);
    EXPECT_EQ(grid_of(first), grid);
    EXPECT_EQ(grid_of(second), grid);
    EXPECT_EQ(froxels_of(second, view), froxels);
    EXPECT_EQ(*grid_of(make_snapshot(scene, Moment{1, 0.5})), *grid);
    EXPECT_NE(froxels_of(second, view_of({4, 2, 4.5f}, {0, 1, 0}, {64, 48})), froxels);

    // All it depends on.
    const auto changed = [&](auto change) {
        Snapshot other = make_snapshot(scene, Moment{1, 0.5}, &first);
        change(other);
        return grid_of(other);
    };
    EXPECT_EQ(changed([](Snapshot&) {}), grid);
    EXPECT_EQ(changed([](Snapshot& s) { s.media[0].optics.albedo = vec3(0.1f); }), grid);
    EXPECT_NE(changed([](Snapshot& s) { s.media[0].optics.extinction *= 2; }), grid);
    EXPECT_NE(changed([](Snapshot& s) { s.media.push_back(s.media[0]); }), grid);
    EXPECT_NE(changed([](Snapshot& s) { s.lights[0].position.x += 0.1f; }), grid);
    EXPECT_NE(changed([](Snapshot& s) { s.lights[0].radius = 0.5f; }), grid);
    EXPECT_NE(changed([](Snapshot& s) {
                  s.media[0].density.bricks = std::make_shared<BrickPool>(*s.media[0].density.bricks);
              }),
              grid);
    EXPECT_NE(make_light_depth(second, second.lights[0], LightTransmittance::grid, 17).grid.depth, grid);
}

TEST(FrameCache, ShadowsAreMadeOnceWhileAllStandsStill) {
    Scene scene = lamp_scene();
    scene.nodes[0].translation = from_to(vec3(0), vec3(1, 0, 0)); // between 0 s and 1 s
    const View view = view_of({4, 2, 4}, {0, 1, 0}, {64, 48}), aside = view_of({4, 2, 4.5f}, {0, 1, 0}, {64, 48});
    const ShadowMapOptions options{64, 2, 1, 0};
    const Snapshot first = make_snapshot(scene, Moment{0, 1}), second = make_snapshot(scene, Moment{1, 2}, &first);
    const Light light = first.lights.at(0);
    const auto map = cached_shadow_map(view, first, light, options);
    const auto volumes = cached_shadow_volumes(first, light);
    const auto seen = cached_shadow_view(first, light, view, 0.5f);
    EXPECT_EQ(volumes->mesh, first.occluders->shadow_mesh());
    EXPECT_FALSE(map->empty() || seen->sides.empty());

    EXPECT_EQ(cached_shadow_map(view, second, light, options), map);
    EXPECT_EQ(cached_shadow_volumes(second, light), volumes);
    EXPECT_EQ(cached_shadow_view(second, light, view, 0.5f), seen);

    EXPECT_NE(cached_shadow_map(aside, second, light, options), map);
    EXPECT_NE(cached_shadow_map(view, second, light, {64, 2, 2, 0}), map);
    EXPECT_NE(cached_shadow_view(second, light, aside, 0.5f), seen);
    EXPECT_NE(cached_shadow_view(second, light, view, 0.6f), seen);
    Light moved = light;
    moved.position.x += 0.1f;
    EXPECT_NE(cached_shadow_map(view, second, moved, options), map);
    EXPECT_NE(cached_shadow_volumes(second, moved), volumes);

    Snapshot less_fog = second;
    less_fog.media.clear();
    EXPECT_NE(cached_shadow_map(view, less_fog, light, options), map);
    const Snapshot before = make_snapshot(scene, Moment{2, 0.5}, &second);
    EXPECT_NE(cached_shadow_map(view, before, light, options), map);
    EXPECT_NE(cached_shadow_volumes(before, light), volumes);
    EXPECT_NE(cached_shadow_view(before, light, view, 0.5f), seen);
}
}
}

// What froxels keep while camera, surfaces and fog stand still.
#include "modes/froxel/history/froxel_history.h"
#include "modes/froxel/settings.h"

#include "modes/froxel/froxel_fixtures.h"
#include "modes/history.h"
#include "render/sequence/provenance.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
TestScene stage() {
    TestScene result = half_shadowed_fog();
    result.snapshot.media.push_back(homogeneous_medium(0.1f, {vec3(-2, 0, -2), vec3(0, 2, 2)}));
    return result;
}

View still_view(float x = 0) { return view_of({x, 1.2f, 9}, {0, 1, 0}); }

FroxelScene scene_of(const Snapshot& snapshot, bool amortize = false) {
    FroxelScene scene;
    scene.snapshot = snapshot;
    scene.settings.tile = 8, scene.settings.amortize = amortize;
    for (const Light& light : snapshot.lights) {
        scene.depths.push_back(make_light_depth(scene.snapshot, light, LightTransmittance::grid, 32));
        scene.cones.push_back(cone_falloff(light)), scene.columns.emplace_back();
    }
    scene.slices.assign(snapshot.lights.size(), &snapshot.occluders->shadow_slices());
    return scene;
}

bool same(const FroxelLight& a, const FroxelLight& b) { return a.values == b.values; }

TEST(FroxelStatics, ASceneSeenBeforeIsTheSame) {
    const TestScene here = stage();
    const FroxelSettings settings = with_tile({}, still_view().size);
    const FroxelStatics first = make_statics(still_view(), here.snapshot, settings, nullptr);
    const FroxelStatics again = make_statics(still_view(), here.snapshot, settings, &first);
    EXPECT_FALSE(first.same_view || first.same_fog);
    EXPECT_TRUE(again.same_view && again.same_fog);
    EXPECT_EQ(again.stood, 1);
    EXPECT_EQ(again.grid.faces, first.grid.faces);
    EXPECT_EQ(again.tiles.depth, first.tiles.depth);
    EXPECT_EQ(again.tiles.trusted_around, first.tiles.trusted_around);
}

TEST(FroxelStatics, WhatMovesIsLookedAtAnew) {
    TestScene here = stage();
    const FroxelSettings settings = with_tile({}, still_view().size);
    const FroxelStatics first = make_statics(still_view(), here.snapshot, settings, nullptr);
    EXPECT_FALSE(make_statics(still_view(0.1f), here.snapshot, settings, &first).same_view);

    here.snapshot.media[1].optics.extinction *= 2;
    const FroxelStatics thicker = make_statics(still_view(), here.snapshot, settings, &first);
    EXPECT_TRUE(thicker.same_view);
    EXPECT_FALSE(thicker.same_fog);
    EXPECT_EQ(thicker.stood, 0);

    // Slices follow fog that leaves them, with some room, and stay while it moves in there.
    here.snapshot.media[1].world_bounds = here.snapshot.media[1].density.bounds = {vec3(-2, 0, -2), vec3(0, 2, 20)};
    const FroxelStatics nearer = make_statics(still_view(), here.snapshot, settings, &first);
    const FroxelStatics fresh = make_statics(still_view(), here.snapshot, settings, nullptr);
    EXPECT_FALSE(nearer.same_froxels);
    EXPECT_LE(nearer.grid.faces.front(), fresh.grid.faces.front());
    EXPECT_GE(nearer.grid.faces.back(), fresh.grid.faces.back());
    EXPECT_LE(nearer.grid.faces.back() - nearer.grid.faces.front(),
              1.1f * (fresh.grid.faces.back() - fresh.grid.faces.front()));

    here.snapshot.media[1].world_bounds.low.z -= 0.05f;
    const FroxelStatics moved_on = make_statics(still_view(), here.snapshot, settings, &nearer);
    EXPECT_TRUE(moved_on.same_froxels);
    EXPECT_FALSE(moved_on.same_fog);
    EXPECT_EQ(moved_on.grid.faces, nearer.grid.faces);
}

TEST(FroxelStatics, KnownFogGivesTheSameBits) {
    for (const bool amortize : {false, true}) {
        const TestScene here = stage();
        const FroxelScene scene = scene_of(here.snapshot, amortize);
        FroxelStatics statics = make_statics(still_view(), here.snapshot, scene.settings, nullptr);
        for (int frame = 0; frame < 3; ++frame) {
            const FroxelLight plain = fill_froxels(scene, statics.grid, statics.tiles, {-1, frame});
            statics = make_statics(still_view(), here.snapshot, scene.settings, &statics);
            ASSERT_TRUE(same(fill_still_froxels(scene, statics, {-1, frame}), plain)) << "noted, frame " << frame;
            ASSERT_TRUE(statics.extinctions[static_cast<size_t>(frame)]);
            ASSERT_TRUE(same(fill_still_froxels(scene, statics, {-1, frame}), plain)) << "known, frame " << frame;
        }
    }
}

// Fog that moves by a hair is found anew in each frame: what settles must come as close to a picture without
// amortizing.
TEST(FroxelStatics, SettledFogIsAsGoodAsFogFoundAnew) {
    const auto after_frames = [](bool amortize, bool restless, float turn) {
        TestScene here = stage();
        const Snapshot statics = here.snapshot;
        Settings settings;
        settings.of<FroxelSettings>().tile = 4, settings.of<FroxelSettings>().amortize = amortize;
        settings = as_wide(settings, still_view().size);
        History history;
        std::vector<Scatter> results;
        for (int frame = 0; frame < 24; ++frame) {
            const float along = static_cast<float>(frame);
            here.snapshot.lights[0].direction = glm::normalize(vec3(0.3f + turn * along, -1, 0.1f));
            if (restless)
                here.snapshot.media[0].optics.extinction =
                    vec3(gray_extinction(statics.media[0].optics) * (1 + 1e-6f * along));
            results = scattered(froxels(still_view(), here.snapshot, settings, &history),
                                pixel_rays(still_view(), here.snapshot, 12));
        }
        EXPECT_EQ(history.froxels->statics.settled(), !restless);
        return results;
    };
    for (const float turn : {0.0f, 0.005f}) {
        const std::vector<Scatter> all = after_frames(false, true, turn);
        const double settled = relative_rmse(after_frames(true, false, turn), all);
        const double restless = relative_rmse(after_frames(true, true, turn), all);
        EXPECT_LT(settled, 1.05 * restless + 0.005) << turn;
    }
}
}
}

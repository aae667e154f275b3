// Things of a frame that come from files: the same bits as made ones, found in any process.
#include "scene/light.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/run_mode.h"
#include "support/scratch.h"
#include "trace/fluence/fluence.h"
#include "trace/fluence/settings.h"
#include "trace/frame_cache.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"
#include "volume/recipe/recipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

Scene prepared_scene() {
    Scene scene;
    add_mesh(scene, quad({-3, 0, -3}, {6, 0, 0}, {0, 0, 6}));
    add_mesh(scene, box_of({-0.5f, 1, -0.5f}, {0.5f, 1.5f, 0.5f}), Node{});
    MediumSource fog;
    fog.name = "mist", fog.kind = MediumKind::noise;
    FogRecipe recipe;
    recipe.voxel_size = 0.2f, recipe.threshold = 0.4f;
    fog.recipe = recipe;
    fog.translation = vec3(0.5f, 0, 0);
    scene.media = {fog};
    LightSource lamp;
    lamp.name = "lamp", lamp.kind = LightKind::spot;
    lamp.position = vec3(0, 3, 0), lamp.direction = vec3(0, -1, 0), lamp.intensity = 10.0f;
    scene.lights = {lamp};
    return scene;
}

std::shared_ptr<CacheFolder> folder_in(const TempFolder& scratch) {
    auto folder = std::make_shared<CacheFolder>(scratch.path());
    folder->writes = true, folder->room = uint64_t{1} << 30;
    return folder;
}

// All that can be kept, made or found.
struct Things {
    Snapshot snapshot;
    LightDepthGrid grid;
    LightDepthFroxels froxels;
    std::shared_ptr<const FluenceGrid> fluence;
    std::shared_ptr<const ShadowMap> map;
};

Things things_of(const Scene& scene, std::shared_ptr<CacheFolder> folder) {
    const View view = view_of({4, 2, 4}, {0, 1, 0}, {64, 48});
    Things things{make_snapshot(scene, Moment{0, 0}, nullptr, MissingFrame::error, std::move(folder)), {}, {}, {}, {}};
    const Snapshot& snapshot = things.snapshot;
    const Light& light = snapshot.lights.at(0);
    things.grid = make_light_depth(snapshot, light, LightTransmittance::grid, 16).grid;
    things.froxels = make_light_depth(snapshot, light, LightTransmittance::froxel, 16, &view).froxels;
    FluenceSettings fluence;
    fluence.orders = 3, fluence.resolution = 8, fluence.paths = 1000;
    things.fluence = cached_fluence(snapshot, fluence);
    things.map = cached_shadow_map(view, snapshot, light, {64, 2, 1, 0});
    return things;
}

std::vector<std::string> names_of(const CacheFolder& folder, CostKind kind) {
    std::vector<std::string> names;
    for (const CacheCost& cost : folder.costs)
        if (cost.kind == kind) names.push_back(cost.what);
    return names;
}

template<class T> std::string bytes_of_fields(const T& thing) {
    T copy = thing;
    CacheWriter writer;
    fields(copy, writer);
    std::string bytes;
    for (const std::string_view piece : writer.pieces()) bytes += piece;
    return bytes;
}

void expect_same(const Things& a, const Things& b) {
    const Medium &one = a.snapshot.media.at(0), &two = b.snapshot.media.at(0);
    EXPECT_EQ(bytes_of_fields(*one.density.bricks), bytes_of_fields(*two.density.bricks));
    EXPECT_EQ(bytes_of_fields(a.grid), bytes_of_fields(b.grid));
    EXPECT_EQ(bytes_of_fields(a.froxels), bytes_of_fields(b.froxels));
    EXPECT_EQ(bytes_of_fields(*a.fluence), bytes_of_fields(*b.fluence));
    EXPECT_EQ(bytes_of_fields(*a.map), bytes_of_fields(*b.map));
}

TEST(PreparedSnapshot, FilesHoldTheBitsThatAreMadeWithout) {
    const TempFolder scratch;
    const Scene scene = prepared_scene();
    const Things plain = things_of(scene, nullptr);
    ASSERT_TRUE(plain.fluence && plain.grid.depth && plain.froxels.depth && !plain.map->empty());
    EXPECT_EQ(plain.snapshot.media.at(0).density.bricks->content, "");
    const auto first = folder_in(scratch);
    expect_same(things_of(scene, first), plain);
    const testing::Matcher<std::vector<std::string>> all =
        testing::ElementsAre("bricks", "light grid", "light froxels", "fluence", "shadow map");
    EXPECT_THAT(names_of(*first, CostKind::cached), all);
    EXPECT_THAT(names_of(*first, CostKind::rebuilt), testing::ElementsAre("surfaces"));

    // As another process finds them: of a scene that was loaded anew.
    const auto second = folder_in(scratch);
    second->files = first->files;
    const Scene same = prepared_scene();
    expect_same(things_of(same, second), plain);
    EXPECT_THAT(names_of(*second, CostKind::found), all);
}

// Which of the things are made anew for a scene and plan that differ a little.
std::vector<std::string> made_anew(const std::function<void(Scene&, CacheFolder&)>& change) {
    const TempFolder scratch;
    const Scene scene = prepared_scene();
    const auto first = folder_in(scratch), second = folder_in(scratch);
    things_of(scene, first);
    Scene changed = prepared_scene();
    second->files = first->files;
    change(changed, *second);
    things_of(changed, second);
    return names_of(*second, CostKind::cached);
}

TEST(PreparedSnapshot, WhatDependsOnAChangeIsMadeAnew) {
    using testing::ElementsAre;
    EXPECT_THAT(made_anew([](Scene&, CacheFolder&) {}), ElementsAre());
    EXPECT_THAT(made_anew([](Scene& scene, CacheFolder&) { scene.media[0].recipe->threshold = 0.45f; }),
                ElementsAre("bricks", "light grid", "light froxels", "fluence"));
    EXPECT_THAT(made_anew([](Scene& scene, CacheFolder&) { scene.media[0].translation = vec3(0.25f, 0, 0); }),
                ElementsAre("light grid", "light froxels", "fluence", "shadow map"));
    EXPECT_THAT(made_anew([](Scene& scene, CacheFolder&) { scene.lights[0].intensity = 20.0f; }),
                ElementsAre("fluence"));
    EXPECT_THAT(made_anew([](Scene& scene, CacheFolder&) { scene.nodes[0].translation = vec3(0.25f, 0, 0); }),
                ElementsAre("fluence", "shadow map"));
    EXPECT_THAT(made_anew([](Scene&, CacheFolder& folder) { folder.plan = "another"; }),
                ElementsAre("light grid", "light froxels", "fluence", "shadow map"));
    EXPECT_THAT(made_anew([](Scene&, CacheFolder& folder) { folder.build = "another"; }),
                ElementsAre("bricks", "light grid", "light froxels", "fluence", "shadow map"));
}

TEST(PreparedSnapshot, FogThatIsEmptyAndNotesOfFilesAreKept) {
    const TempFolder scratch;
    Scene scene = prepared_scene();
    scene.media[0].recipe->threshold = 1;
    const auto first = folder_in(scratch), second = folder_in(scratch);
    EXPECT_EQ(make_snapshot(scene, Moment{0, 0}, nullptr, MissingFrame::error, first).media.size(), 0u);
    second->files = first->files;
    EXPECT_EQ(make_snapshot(scene, Moment{0, 0}, nullptr, MissingFrame::error, second).media.size(), 0u);
    EXPECT_THAT(names_of(*second, CostKind::found), testing::ElementsAre("bricks"));
}

TEST(PreparedSnapshot, AKeyWithAnObjectThatTellsNothingNamesNoFile) {
    const CacheFolder folder;
    const auto number = std::make_shared<int>(1);
    EXPECT_EQ(content_of(CacheKey().add(1).add(number), folder), "");
    const auto bricks = std::make_shared<BrickPool>();
    EXPECT_EQ(content_of(CacheKey().add(bricks), folder), "");
    bricks->content = "fog";
    EXPECT_NE(content_of(CacheKey().add(bricks), folder), "");
    EXPECT_NE(content_of(CacheKey().add(bricks).add(1), folder), content_of(CacheKey().add(bricks).add(2), folder));
    EXPECT_NE(content_of(CacheKey().add(1), folder), "");
}
}
}

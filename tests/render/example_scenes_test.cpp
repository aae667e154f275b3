// The example scenes through the whole chain: files, snapshot, march.
#include "base/io/file.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/run_mode.h"
#include "support/scratch.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/recipe/bake.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tyndall {
namespace {
using namespace test;

const std::filesystem::path source_dir = TYNDALL_SOURCE_DIR;

// Fog light of pixel centers at a small size, without jitter.
std::vector<Scatter> fog_light(const Snapshot& snapshot, const Camera& camera, const Settings& settings) {
    View view;
    view.camera = camera, view.size = {64, 36};
    return run_mode("march", view, snapshot, settings, pixel_rays(view, snapshot, 20));
}

TEST(ExampleScenes, MarchConvergesOnTheWindow) {
    // Edges of shafts make the march first order in its step; each run is held against one eight times finer.
    const Scene scene = load_scene(source_dir / "scenes/window.json");
    const Snapshot snapshot = make_snapshot(scene, moment_of(scene, 1));
    const Camera camera = camera_at(scene, scene.camera, 0);
    Settings settings = settings_for(Quality::final);
    settings.march.step_voxels = 64, settings.march.step_depth = 10;
    const auto run = [&](int steps) {
        settings.march.step_share = 1.0f / static_cast<float>(steps);
        return fog_light(snapshot, camera, settings);
    };
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const int steps : {16, 32, 64, 128}) {
        const double level = std::log2(steps), error = std::log2(relative_rmse(run(steps), run(8 * steps)));
        ++n, x += level, y += error, xx += level * level, xy += level * error;
    }
    const double slope = (n * xy - x * y) / (n * xx - x * x);
    RecordProperty("slope", std::to_string(slope));
    EXPECT_LE(slope, -0.8);
}

TEST(ExampleScenes, HalvingTheBoundsOfTheReferenceChangesNothing) {
    for (const char* name : {"window", "spotlight"}) {
        const Scene scene = load_scene(source_dir / "scenes" / (std::string(name) + ".json"));
        const Snapshot snapshot = make_snapshot(scene, moment_of(scene, 1));
        const Camera camera = camera_at(scene, scene.camera, 0);
        Settings settings = settings_for(Quality::reference);
        const auto reference = fog_light(snapshot, camera, settings);
        settings.march.step_depth /= 2, settings.march.step_voxels /= 2, settings.march.step_share /= 2;
        settings.march.near_light /= 2;
        const auto halved = fog_light(snapshot, camera, settings);
        EXPECT_LT(relative_rmse(reference, halved), 1e-4) << name;
        EXPECT_GT(halved[0].steps, reference[0].steps) << name;
    }
}

TEST(ExampleScenes, RecipeRenderedDirectlyEqualsItsBake) {
    const TempFolder scratch;
    FogRecipe recipe = read_recipe(source_dir / "volumes/lamp_dust.json");
    recipe.voxel_size = 0.1f;
    Progress progress(ProgressStyle::none, "bake", 1);
    bake(recipe, (scratch / "dust.####.vdb").string(), {12}, {}, progress);

    Scene direct = load_scene(source_dir / "scenes/lantern.json"), baked = direct;
    direct.media[0].recipe->voxel_size = recipe.voxel_size, direct.media[0].voxel_size = recipe.voxel_size;
    baked.media[0].kind = MediumKind::vdb, baked.media[0].recipe.reset();
    baked.media[0].sequence = find_sequence("dust.####.vdb", scratch.path());
    const Camera camera = camera_at(direct, direct.camera, 0.5);
    const Settings settings = settings_for(Quality::preview);
    const auto grown = fog_light(make_snapshot(direct, moment_of(direct, 12)), camera, settings);
    const auto read = fog_light(make_snapshot(baked, moment_of(baked, 12)), camera, settings);
    EXPECT_LT(relative_rmse(read, grown), 1e-3); // half floats on disk and in the bricks
}

TEST(ExampleScenes, AFireRenderedDirectlyEqualsItsBake) {
    const TempFolder scratch;
    FogRecipe recipe = read_recipe(source_dir / "volumes/campfire.json");
    recipe.voxel_size = 0.05f;
    Progress progress(ProgressStyle::none, "bake", 1);
    bake(recipe, (scratch / "fire.####.vdb").string(), {12}, {}, progress);

    Scene direct = load_scene(source_dir / "scenes/campfire.json"), baked = direct;
    MediumSource &grown = direct.media[0], &read = baked.media[0];
    ASSERT_TRUE(grown.blackbody && grown.recipe && grown.recipe->fire);
    grown.voxel_size = static_cast<float>(recipe.voxel_size);
    read.kind = MediumKind::vdb, read.recipe.reset();
    read.sequence = find_sequence("fire.####.vdb", scratch.path());
    read.temperature = GridSource{read.sequence, {"temperature"}, {}};
    const Camera camera = camera_at(direct, direct.camera, 0.5);
    const Settings settings = settings_for(Quality::preview);
    const auto expected = fog_light(make_snapshot(direct, moment_of(direct, 12)), camera, settings);
    const auto found = fog_light(make_snapshot(baked, moment_of(baked, 12)), camera, settings);
    EXPECT_GT(max_component(expected[64 * 18 + 32].radiance), 100) << "no fire in the middle of the picture";
    EXPECT_LT(relative_rmse(found, expected), 1e-3); // half floats on disk and in the bricks
}

TEST(ExampleScenes, AllLoadWithoutWarnings) {
    for (const char* name : {"window", "spotlight", "pillars", "lantern", "cloud", "campfire", "forest_morning",
                             "concert", "cumulus_sky"}) {
        const Scene scene = load_scene(source_dir / "scenes" / (std::string(name) + ".json"));
        EXPECT_TRUE(scene.warnings.empty()) << name << ": " << scene.warnings.front();
        EXPECT_FALSE(scene.media.empty());
    }
}
}
}

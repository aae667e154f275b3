// The example scenes through the whole chain: files, snapshot, march.
#include "base/io/file.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/scratch.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/recipe/bake.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tyndall {
namespace {
const std::filesystem::path source_dir = TYNDALL_SOURCE_DIR;

// Fog light of pixel centres at a small size, without jitter.
std::vector<Scatter> fog_light(const Snapshot& snapshot, const Camera& camera, const Settings& settings) {
    const ivec2 size{64, 36};
    const ScatterFunction scatter = find_mode("march").prepare(View{}, snapshot, settings, nullptr);
    std::vector<Scatter> results(static_cast<size_t>(size.x) * size.y);
    for (size_t first = 0; first < results.size(); first += 16) {
        Ray rays[16];
        uint32_t ids[16] = {};
        for (size_t i = 0; i < 16; ++i) {
            const int pixel = static_cast<int>(first + i);
            rays[i] = camera_ray(camera, size, vec2(pixel % size.x, pixel / size.x) + 0.5f);
            rays[i].t_max = 20;
        }
        Hits hits;
        snapshot.occluders->closest(rays, 0, hits);
        for (size_t i = 0; i < 16; ++i) rays[i].t_max = std::min(rays[i].t_max, hits.t[i]);
        scatter({rays, ids, {}, {}}, std::span(results).subspan(first, 16));
    }
    return results;
}

double relative_error(const std::vector<Scatter>& a, const std::vector<Scatter>& reference) {
    double squared = 0, sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        squared += std::pow(luminance(a[i].radiance - reference[i].radiance), 2);
        sum += luminance(reference[i].radiance);
    }
    return std::sqrt(squared * a.size()) / sum;
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
        const double level = std::log2(steps), error = std::log2(relative_error(run(steps), run(8 * steps)));
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
        EXPECT_LT(relative_error(reference, halved), 1e-4) << name;
        EXPECT_GT(halved[0].steps, reference[0].steps) << name;
    }
}

TEST(ExampleScenes, RecipeRenderedDirectlyEqualsItsBake) {
    const Scratch scratch;
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
    EXPECT_LT(relative_error(read, grown), 1e-3); // half floats on disk and in the bricks
}

TEST(ExampleScenes, AllLoadWithoutWarnings) {
    for (const char* name : {"window", "spotlight", "pillars", "lantern", "cloud"}) {
        const Scene scene = load_scene(source_dir / "scenes" / (std::string(name) + ".json"));
        EXPECT_TRUE(scene.warnings.empty()) << name << ": " << scene.warnings.front();
        EXPECT_FALSE(scene.media.empty());
    }
}
}
}

// Frames that share what stands still: the same bits as alone, and nothing made twice.
#include "base/io/file.h"
#include "base/io/frames.h"
#include "modes/mode.h"
#include "render/fixtures.h"
#include "render/sequence/sequence.h"
#include "scene/light.h"
#include "scene/lights/light_kind.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "support/scratch.h"
#include "trace/frame_cache.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tyndall::test {
namespace {
enum class Moves { nothing, light, camera, mesh, fog, brightness };

// A slab with a gap's edge above a floor, drifting fog and a lamp; one of them moves.
Scene small_scene(const TempFolder& directory, Moves moves) {
    Scene scene;
    scene.file = directory.file("scene.json");
    std::ofstream(scene.file) << "{}";
    scene.inputs = {{scene.file, content_hash("{}")}};
    scene.resolution = {24, 16};
    scene.frame_rate = 4;
    CameraSource camera;
    camera.name = "main";
    camera.position = vec3(0, 1, 4), camera.target = vec3(0, 1, 0);
    if (moves == Moves::camera) camera.position = from_to(vec3(0, 1, 4), vec3(0.5f, 1.5f, 4));
    scene.cameras = {camera};

    add_plane(scene, -2, 3, vec3(0));
    add_plane(scene, 0, 0.4f, vec3(0));
    scene.materials[0].base_color = scene.materials[1].base_color = vec3(0.5f);
    Node node;
    if (moves == Moves::mesh) node.translation = from_to(vec3(0), vec3(0.5f, 0, 0));
    scene.nodes = {node};
    scene.instances[1].node = 0;

    MediumSource fog;
    fog.name = "mist", fog.kind = MediumKind::noise, fog.extinction = Keyed<float>(0.4f);
    FogRecipe recipe;
    recipe.voxel_size = 0.25f, recipe.threshold = 0.3f;
    if (moves == Moves::fog) recipe.wind = vec3(1, 0, 0);
    fog.recipe = recipe;
    scene.media = {fog};
    LightSource lamp;
    lamp.name = "lamp", lamp.kind = LightKind::spot;
    lamp.position = vec3(0.5f, 2.5f, 1.5f), lamp.direction = vec3(-0.2f, -1, -0.7f);
    lamp.intensity = Keyed<float>(20.0f);
    if (moves == Moves::light) lamp.position = from_to(vec3(0.5f, 2.5f, 1.5f), vec3(0.8f, 2.5f, 1.5f));
    if (moves == Moves::brightness) lamp.intensity = from_to(20.0f, 30.0f);
    scene.lights = {lamp};
    scene.ambient = Keyed<vec3>(vec3(0.01f));
    return scene;
}

RenderRequest job_for(const Scene& scene, const std::string& mode, const std::string& output, std::vector<int> frames) {
    RenderRequest job;
    job.scene_file = scene.file, job.output = output, job.frames = std::move(frames), job.mode = mode;
    job.settings = settings_for(Quality::draft);
    job.settings.pixel.samples = 1;
    job.isa = "avx2";
    return job;
}

RenderReport run(const Scene& scene, const RenderRequest& job, const Mode& mode, LoadedFrame first = {}) {
    Progress progress(ProgressStyle::none, "render", static_cast<double>(job.frames.size()));
    std::atomic<bool> cancel = false;
    return render_sequence(scene, job, {&mode, job.settings, {}, {}, {}}, progress, cancel, &first);
}

// A thing that counts how often it was made and how many of it there are.
struct Counted {
    static inline std::atomic<int> made = 0, alive = 0, max_alive = 0;
    Counted() { ++made, max_alive = std::max<int>(max_alive, ++alive); }
    Counted(Counted&&) noexcept { ++alive; }
    ~Counted() { --alive; }
    static void reset() { made = 0, max_alive = 0; }
};

bool each_frame_anew = false;
std::atomic<int> prepared = 0;
ScatterFunction prepare_counted(const View&, const Snapshot& snapshot, const Settings&, History*) {
    ++prepared;
    const CacheKey key = CacheKey().add(snapshot.occluders).add(each_frame_anew ? snapshot.seconds : 0.0);
    cached(snapshot, "thing", key, [] { return Counted(); });
    return [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); };
}

std::vector<std::shared_ptr<const BrickPool>> fog_seen;
ScatterFunction prepare_noting_fog(const View&, const Snapshot& snapshot, const Settings&, History*) {
    fog_seen.push_back(snapshot.media.at(0).density.bricks);
    return [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); };
}
}

class SequenceOfMode : public testing::TestWithParam<const char*> {};

TEST_P(SequenceOfMode, FramesAreTheSameAloneAndInARow) {
    for (const Moves moves :
         {Moves::nothing, Moves::light, Moves::camera, Moves::mesh, Moves::fog, Moves::brightness}) {
        const TempFolder in, row, alone;
        const Scene scene = small_scene(in, moves);
        const Mode& mode = find_mode(GetParam());
        RenderRequest job = job_for(scene, GetParam(), row.file("f.####.exr"), {1, 2, 3});
        run(scene, job, mode);
        job.output = alone.file("f.####.exr");
        for (const int frame : {1, 2, 3}) {
            job.frames = {frame};
            run(scene, job, mode);
            const std::string name = frame_name("f.####.exr", frame);
            EXPECT_EQ(row.contents().at(name), alone.contents().at(name)) << static_cast<int>(moves) << ' ' << frame;
        }
        if (moves == Moves::nothing) continue;
        const auto first = color_of(read_exr(row.file("f.0001.exr"))).pixels;
        EXPECT_FALSE(first == color_of(read_exr(row.file("f.0003.exr"))).pixels) << "what moves is not seen to";
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, SequenceOfMode,
                         testing::Values("march", "froxel", "shadow-volume", "shadow-map", "billboard"));

TEST(SequenceKept, MarchesWithEveryShadowAreTheSameAloneAndInARow) {
    for (const char* visibility : {"maps", "intervals"}) {
        const TempFolder in, row, alone;
        const Scene scene = small_scene(in, Moves::light);
        RenderRequest job = job_for(scene, "march", row.file("f.####.exr"), {1, 2, 3});
        apply_setting(job.settings, std::string("march.visibility=") + visibility);
        run(scene, job, find_mode("march"));
        job.output = alone.file("f.####.exr"), job.frames = {3};
        run(scene, job, find_mode("march"));
        EXPECT_EQ(row.contents().at("f.0003.exr"), alone.contents().at("f.0003.exr")) << visibility;
    }
}

TEST(SequenceKept, HistoryIsTheSameAloneAndInARow) {
    const TempFolder in, row, alone;
    const Scene scene = small_scene(in, Moves::camera);
    RenderRequest job = job_for(scene, "froxel", row.file("f.####.exr"), {1, 2, 3, 4});
    job.history = 2;
    run(scene, job, find_mode("froxel"));
    job.output = alone.file("f.####.exr"), job.frames = {4};
    run(scene, job, find_mode("froxel"));
    EXPECT_EQ(row.contents().at("f.0004.exr"), alone.contents().at("f.0004.exr"));
}

TEST(SequenceKept, WhatStandsStillIsMadeOnce) {
    const TempFolder in, out;
    const Scene scene = small_scene(in, Moves::camera);
    RenderRequest job = job_for(scene, "test", out.file("f.####.exr"), {1, 2, 3, 4, 5, 6});
    each_frame_anew = false;
    for (const int history : {0, 3}) {
        Counted::reset(), prepared = 0;
        job.history = history;
        run(scene, job, mode_of(prepare_counted));
        EXPECT_EQ(prepared, 6 * (history + 1));
        EXPECT_EQ(Counted::made, 1) << history;
        EXPECT_EQ(Counted::alive, 0);
    }
}

TEST(SequenceKept, WhatMovesIsGoneTwoFramesLater) {
    const TempFolder in, out;
    const Scene scene = small_scene(in, Moves::camera);
    RenderRequest job = job_for(scene, "test", out.file("f.####.exr"), {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    each_frame_anew = true;
    Counted::reset();
    run(scene, job, mode_of(prepare_counted));
    EXPECT_EQ(Counted::made, 12);
    EXPECT_LE(Counted::max_alive, 2);
    EXPECT_EQ(Counted::alive, 0);
}

TEST(SequenceKept, FramesIncludeTheTimeTheyWaitedForTheirFog) {
    const TempFolder in, out;
    Scene scene = small_scene(in, Moves::fog);
    scene.media[0].recipe->voxel_size = 0.02f; // takes longer to load than to render
    RenderRequest job = job_for(scene, "test", out.file("f.####.exr"), {1, 2, 3});
    job.resolution = {4, 4};
    const RenderReport report = run(scene, job, mode_of(prepare_noting_fog));
    double loading = 0, seconds = 0;
    for (const FrameReport& frame : report.frames) loading += frame.load_seconds, seconds += frame.seconds;
    EXPECT_GE(seconds, 0.99 * loading);
    EXPECT_LE(seconds, report.seconds);
}

TEST(SequenceKept, TheFirstFrameIsLoadedOnce) {
    const TempFolder in, out;
    const Scene scene = small_scene(in, Moves::fog);
    const RenderRequest job = job_for(scene, "test", out.file("f.####.exr"), {1, 2});
    LoadedFrame first = load_first_frame(scene, job);
    EXPECT_EQ(first.snapshot.frame, 1);
    EXPECT_GT(first.seconds, 0);
    const auto bricks = first.snapshot.media.at(0).density.bricks;
    fog_seen.clear();
    const RenderReport report = run(scene, job, mode_of(prepare_noting_fog), std::move(first));
    ASSERT_EQ(fog_seen.size(), 2u);
    EXPECT_EQ(fog_seen[0], bricks);
    EXPECT_NE(fog_seen[1], bricks);
    EXPECT_GT(report.frames[0].load_seconds, 0);
    EXPECT_GT(report.loading, 0);
    EXPECT_GE(report.frames[0].seconds, report.loading);

    // That of another scene is not taken.
    const Scene other = scene;
    fog_seen.clear();
    run(scene, job, mode_of(prepare_noting_fog), load_first_frame(other, job));
    EXPECT_NE(fog_seen[0], bricks);
    fog_seen.clear();
}
}

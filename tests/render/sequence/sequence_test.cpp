// Frames of a sequence, what is written with them and reported of them.
#include "base/io/frames.h"
#include "base/json/json.h"
#include "integrate/ray_batch.h"
#include "modes/mode.h"
#include "render/sequence/sequence_fixtures.h"
#include "scene/file/scene_file.h"
#include "scene/scene.h"
#include "support/threads.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
ScatterFunction prepare_not_finite(const View& view, const Snapshot&, const Settings&, History*) {
    return [frame = view.frame](const RayBatch&, std::span<Scatter> results) {
        for (Scatter& result : results) result = {vec3(frame == 2 ? NAN : 1), 1, 1, 0};
    };
}
}

TEST(Sequence, WritesEveryFrame) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 5, -3});
    job.png = true;
    const RenderReport report = run(scene, job);
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.-0003.exr", "f.-0003.png", "f.0001.exr", "f.0001.png",
                                                     "f.0002.exr", "f.0002.png", "f.0005.exr", "f.0005.png"}));
    ASSERT_EQ(report.frames.size(), 4u);
    EXPECT_FALSE(report.cancelled);
    EXPECT_GT(report.peak_memory_bytes, uint64_t{1} << 20);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(report.frames[i].frame, job.frames[i]);
        EXPECT_EQ(report.frames[i].file, frame_name(job.output, job.frames[i]));
        EXPECT_EQ(report.frames[i].stats.camera_rays, 40u * 30);
        EXPECT_FALSE(report.frames[i].kept);
    }
}

TEST(Sequence, HasTheSameBytesForAnyThreadCount) {
    const TempFolder in, one, two;
    const Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, one.file("f.####.exr"), {1, 2, 3, 4});
    job.png = true;
    on_threads(1, [&] { return run(scene, job); });
    job.output = two.file("f.####.exr");
    on_threads(2, [&] { return run(scene, job); });
    EXPECT_EQ(one.contents(), two.contents());
}

TEST(Sequence, FramesDoNotDependOnTheOthers) {
    const TempFolder in, all, single;
    const Scene scene = moving_scene(in);
    run(scene, job_for(scene, all.file("f.####.exr"), {1, 2, 3}));
    run(scene, job_for(scene, single.file("f.####.exr"), {3}));
    EXPECT_EQ(all.contents()["f.0003.exr"], single.contents()["f.0003.exr"]);
}

TEST(Sequence, SaysHowItWasMade) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, out.file("f.exr"), {12});
    job.settings.pixel.samples = 3;
    job.seed = 77;
    run(scene, job);
    const auto attributes = read_exr(out.file("f.exr")).attributes;
    EXPECT_EQ(attributes.at("tyndall:mode"), "test");
    EXPECT_EQ(attributes.at("tyndall:scene"), "scene.json");
    EXPECT_EQ(attributes.at("tyndall:camera"), "main");
    EXPECT_EQ(attributes.at("tyndall:isa"), "avx2");
    EXPECT_EQ(attributes.at("tyndall:nonFinite"), "0");
    EXPECT_EQ(attributes.at("imageCounter"), "12");
    EXPECT_EQ(attributes.at("tyndall:hash").size(), 32u);
    const std::string settings = attributes.at("tyndall:settings");
    for (const SettingRow& row : setting_rows())
        EXPECT_NE(settings.find(row.name + "=" + row.get(job.settings)), settings.npos) << row.name;
    const std::string command = attributes.at("tyndall:command");
    for (const char* part : {"--frames 12", "--seed 77", "--res 40x30", "--set pixel.samples=3", "--isa avx2"})
        EXPECT_NE(command.find(part), command.npos) << part << " in " << command;
    for (const auto& [name, text] : attributes) EXPECT_EQ(text.find(out.path().string()), text.npos) << name;
}

TEST(Sequence, TheCommandInTheHeaderNamesFoldersAndOutput) {
    const TempFolder folder, elsewhere;
    std::filesystem::create_directories(folder.path() / "a b/out");
    std::filesystem::create_directories(elsewhere.path() / "x");
    const Scene scene = moving_scene(folder);
    RenderRequest job = job_for(scene, folder.file("a b/out/f.####.exr"), {12});
    job.mode = "march";
    const auto command = [&](const char* scene_file, const std::string& output) {
        job.scene_file = scene_file[0] == '/' ? folder.path() / (scene_file + 1) : std::filesystem::path(scene_file);
        job.output = output;
        const View view = view_of(scene, job, job.settings, 12);
        std::string text = provenance_of(scene, job, requested_plan(job), view, "", {}).attributes["tyndall:command"];
        return text.substr(0, text.find(" --mode"));
    };
    // From the deepest folder that holds both, where that is not the working one.
    EXPECT_EQ(command("/a b/scene.json", folder.file("a b/out/f.####.exr")),
              "tyndall render scene.json -o 'out/f.####.exr' --frames 12");
    EXPECT_EQ(command("/scene.json", folder.file("a b/out/f.####.exr")),
              "tyndall render scene.json -o 'a b/out/f.####.exr' --frames 12");
    // From the working folder, however the names were given.
    const std::string here = std::filesystem::current_path().string();
    EXPECT_EQ(command("shots/./scene.json", here + "/out/f.exr"),
              "tyndall render shots/scene.json -o out/f.exr --frames 12");
    // Nothing in common: folder and name.
    EXPECT_EQ(command("scenes/scene.json", "/mnt/farm/7/shot/f.exr"),
              "tyndall render scenes/scene.json -o shot/f.exr --frames 12");
}

TEST(Sequence, CountsSamplesThatAreNotFinite) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    const RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3});
    const RenderReport report = run(scene, job, mode_of(prepare_not_finite));
    EXPECT_EQ(report.non_finite, 40u * 30);
    EXPECT_EQ(report.frames[1].stats.non_finite, 40u * 30);
    const auto attributes = read_exr(out.file("f.0002.exr")).attributes;
    EXPECT_EQ(attributes.at("tyndall:nonFinite"), "1200");
    EXPECT_EQ(attributes.at("tyndall:firstNonFinite"), "0,0");
}

TEST(Sequence, ReportsItselfAsJson) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3});
    const Mode mode = mode_of(prepare_not_finite);
    const RenderReport report = run(scene, job, mode);
    const Json json = parse_json(stats_json(report, job, {&mode, job.settings, {}, {}, {}}), "stats");
    EXPECT_EQ(json.string_or("schema", ""), "tyndall-render-stats");
    EXPECT_EQ(json.number_or("schema_version", 0), 1);
    EXPECT_EQ(json.string_or("mode", ""), "test");
    EXPECT_EQ(json.find("settings")->members.size(), setting_rows().size());
    ASSERT_EQ(json.find("frames")->items.size(), 3u);
    const Json& frame = json.find("frames")->items[1];
    EXPECT_EQ(frame.number_or("frame", 0), 2);
    EXPECT_EQ(frame.number_or("non_finite", 0), 1200);
    EXPECT_TRUE(frame.has("first_non_finite"));
    const Json* totals = json.find("totals");
    EXPECT_EQ(totals->number_or("camera_rays", 0), 3 * 1200);
    EXPECT_EQ(totals->number_or("non_finite", 0), 1200);
    EXPECT_GT(totals->number_or("peak_memory_bytes", 0), 0);
}

// A cone knows no shadows of pillars. What it took counts.
TEST(Sequence, WhatThePlansTechniqueIsTooFarOffForIsRenderedByTheMainOne) {
    const TempFolder out;
    const Scene scene = load_scene(std::filesystem::path(TYNDALL_SOURCE_DIR) / "scenes/pillars.json");
    RenderRequest job = job_for(scene, out.file("f.exr"), {1});
    job.settings = settings_for(Quality::preview), job.target_error = 0.1, job.resolution = {32, 18};
    Progress progress(ProgressStyle::none, "render", 1);
    std::atomic<bool> cancel = false;
    RenderPlan plan{&find_mode("cone"), job.settings, "chosen", nullptr, nullptr};
    const RenderReport alone = render_sequence(scene, job, plan, progress, cancel);
    EXPECT_EQ(alone.missed, 1) << "asked for by name";
    EXPECT_EQ(read_exr(out.file("f.exr")).attributes.at("tyndall:mode"), "cone");
    plan.wanted = std::make_shared<const Settings>(job.settings);
    const RenderReport both = render_sequence(scene, job, plan, progress, cancel);
    EXPECT_EQ(both.missed, 0);
    EXPECT_EQ(read_exr(out.file("f.exr")).attributes.at("tyndall:mode"), "march");

    RenderRequest march = job;
    march.mode = "march";
    const RenderReport by_march = render_sequence(scene, march, requested_plan(march), progress, cancel);
    const FrameStats &cone = alone.frames[0].stats, &main = by_march.frames[0].stats, &sum = both.frames[0].stats;
    EXPECT_EQ(sum.camera_rays, cone.camera_rays + main.camera_rays);
    EXPECT_EQ(sum.steps, cone.steps + main.steps);
    EXPECT_EQ(sum.samples, main.samples);
    EXPECT_GE(both.frames[0].seconds, sum.goal_seconds);
    EXPECT_GE(sum.goal_seconds, sum.prepare_seconds + sum.render_seconds) << "of both";
}
}

// Noise in files, headers and reports of sequences.
#include "base/clock.h"
#include "base/error.h"
#include "base/image.h"
#include "base/json/json.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/frame/noise_fixtures.h"
#include "render/sequence/sequence.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/scratch.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
Scene small_scene() {
    Scene scene;
    scene.resolution = {16, 12};
    scene.cameras = {CameraSource{}};
    return scene;
}

RenderRequest job_for(const TempFolder& out, std::vector<int> frames = {1}) {
    RenderRequest job;
    job.scene_file = "scene.json";
    job.output = out.file("f.####.exr");
    job.frames = std::move(frames);
    job.mode = "own";
    job.settings.pixel.filter = PixelFilter::box;
    return job;
}

RenderReport run(const RenderRequest& job, const Mode& mode = own_mode(prepare_random)) {
    static const Scene scene = small_scene();
    Progress progress(ProgressStyle::silent, "render", static_cast<double>(job.frames.size()));
    std::atomic<bool> cancel = false;
    return render_sequence(scene, job, {&mode, job.settings, {}, {}, {}}, progress, cancel);
}

double number_of(const ExrFile& exr, const std::string& attribute) { return std::stod(exr.attributes.at(attribute)); }
}

TEST(NoiseFiles, VariancesAndHalvesKeepAllTheirBits) {
    const TempFolder directory;
    Layers layers;
    layers.display = layers.size = {3, 2};
    layers.color = layers.inscatter = Image<vec3>(layers.size, vec3(0.1f));
    layers.alpha = layers.depth = layers.transmittance = layers.validity = Image<float>(layers.size, 1.0f);
    layers.variance = Image<vec3>(layers.size, vec3(1.2345678e-20f, 3e-9f, 7));
    layers.half_a = Image<vec3>(layers.size, vec3(0.1f, 0.2f, 70000));
    layers.half_b = Image<vec3>(layers.size, vec3(0.3f, 0.7f, 1e-12f));
    const ExrOptions options{{"variance", "halves"}, false};
    write_exr(directory.file("a.exr"), layers, {}, options);
    const ExrFile exr = read_exr(directory.file("a.exr"));

    std::vector<std::string> names;
    for (const auto& channel : exr.channels) names.push_back(channel.first);
    EXPECT_EQ(names, channel_names({}, false, options));
    EXPECT_EQ(names.size(), 4u + 9);
    const auto expect = [&](const std::string& layer, vec3 value) {
        for (int c = 0; c < 3; ++c) EXPECT_EQ(exr.channel(layer + "RGB"[c])->at(2, 1), value[c]) << layer << c;
    };
    expect("Variance.", layers.variance.at(2, 1));
    expect("half_a.", layers.half_a.at(2, 1));
    expect("half_b.", layers.half_b.at(2, 1));
    EXPECT_NE(exr.channel("R")->at(0, 0), 0.1f) << "colors are halves unless asked otherwise";
    write_exr(directory.file("a.exr"), layers, {}, {{}, true});
    EXPECT_EQ(read_exr(directory.file("a.exr")).channel("R")->at(0, 0), 0.1f);
}

TEST(NoiseFiles, HeaderSaysHowNoisyThePictureIs) {
    const TempFolder out;
    RenderRequest job = job_for(out);
    job.settings.pixel.samples = 3;
    run(job);
    EXPECT_EQ(read_exr(out.file("f.0001.exr")).attributes.count("tyndall:samples"), 0u);

    job.exr.layers = {"variance", "halves"};
    RenderReport report = run(job);
    ExrFile exr = read_exr(out.file("f.0001.exr"));
    EXPECT_EQ(exr.attributes.at("tyndall:samples"), "64");
    EXPECT_NEAR(number_of(exr, "tyndall:achievedError"), report.frames[0].stats.noise->error, 1e-9);
    EXPECT_NEAR(number_of(exr, "tyndall:errorBound"), report.frames[0].stats.noise->bound, 1e-9);
    EXPECT_EQ(exr.attributes.count("tyndall:targetError"), 0u);
    // The variance in the file is the one the error is made from.
    double variance = 0, mean = 0;
    for (const char* c : {"R", "G", "B"})
        for (size_t i = 0; i < 16 * 12; ++i) {
            variance += exr.channel(std::string("Variance.") + c)->pixels[i];
            mean += 0.5 * exr.channel(std::string("half_a.") + c)->pixels[i];
            mean += 0.5 * exr.channel(std::string("half_b.") + c)->pixels[i];
        }
    const double values = 3.0 * 16 * 12;
    EXPECT_NEAR(number_of(exr, "tyndall:achievedError"), std::sqrt(variance / values) / (mean / values), 1e-6);

    job.exr.layers = {}, job.target_error = 0.05;
    report = run(job);
    exr = read_exr(out.file("f.0001.exr"));
    EXPECT_EQ(exr.attributes.at("tyndall:targetError"), "0.05");
    EXPECT_EQ(number_of(exr, "tyndall:samples"), report.frames[0].stats.samples);
    EXPECT_LE(number_of(exr, "tyndall:errorBound"), 0.05);
    EXPECT_NE(exr.attributes.at("tyndall:command").find("--target-error 0.05"), std::string::npos);
    EXPECT_EQ(report.missed, 0);
}

TEST(NoiseFiles, ResumeKnowsTargetsAndKeepsWhatWasReached) {
    const TempFolder out;
    RenderRequest job = job_for(out, {1, 2});
    job.resume = true, job.target_error = 0.05;
    const RenderReport first = run(job), second = run(job);
    for (int i = 0; i < 2; ++i) {
        EXPECT_FALSE(first.frames[i].kept);
        EXPECT_TRUE(second.frames[i].kept);
        EXPECT_EQ(second.frames[i].stats.samples, first.frames[i].stats.samples);
        EXPECT_NEAR(second.frames[i].stats.noise->error, first.frames[i].stats.noise->error, 1e-9);
    }
    job.target_error = 0.04;
    EXPECT_FALSE(run(job).frames[0].kept);
    job.target_error = 0;
    EXPECT_FALSE(run(job).frames[0].kept);
    job.exr.layers.push_back("variance");
    EXPECT_FALSE(run(job).frames[0].kept);
    EXPECT_TRUE(run(job).frames[0].kept);
}

TEST(NoiseFiles, AMissIsCountedAlsoWhenKept) {
    const TempFolder out;
    RenderRequest job = job_for(out);
    job.resolution = {2, 2};
    // What all samples there may be are likely to get to; they cannot promise it.
    const double likely = std::sqrt(random_variance / max_target_samples) / random_mean;
    job.resume = true, job.target_error = likely;
    const Mode mode = own_mode(prepare_random);
    for (const bool kept : {false, true}) {
        const RenderReport report = run(job, mode);
        EXPECT_EQ(report.frames[0].kept, kept);
        EXPECT_EQ(report.missed, 1);
        const Json json = parse_json(stats_json(report, job, {&mode, job.settings, {}, {}, {}}), "stats");
        EXPECT_NEAR(json.number_or("target_error", 0), likely, 1e-6 * likely);
        EXPECT_EQ(json.number_or("missed", 0), 1);
        const Json& frame = json.find("frames")->items[0];
        EXPECT_EQ(frame.number_or("samples", 0), max_target_samples);
        EXPECT_GT(frame.number_or("error_bound", 0), frame.number_or("achieved_error", 1));
        EXPECT_NEAR(frame.number_or("achieved_error", 0), likely, 0.2 * likely);
        EXPECT_GT(frame.number_or("error_bound", 0), likely);
    }
}

TEST(NoiseFiles, WhatPassedBeforeRenderingCountsInItsTime) {
    const TempFolder out;
    RenderRequest job = job_for(out);
    job.time_budget = 2;
    job.started = steady_seconds() - 3; // all of it
    EXPECT_LT(run(job).frames[0].stats.goal_seconds, 1);
}

TEST(NoiseFiles, TargetsNeedAModeWhoseErrorIsNoise) {
    const TempFolder out;
    RenderRequest job = job_for(out);
    job.target_error = 0.1;
    error_message(ExitCode::usage, [&] { run(job, mode_of(prepare_random)); });
    EXPECT_TRUE(out.names().empty());
}
}

// --resume: frames that are right are kept, the rest is made anew.
#include "base/io/file.h"
#include "render/sequence/sequence_fixtures.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tyndall::test {
namespace {
std::vector<bool> kept_of(const RenderReport& report) {
    std::vector<bool> kept;
    for (const FrameReport& frame : report.frames) kept.push_back(frame.kept);
    return kept;
}
}

TEST(Sequence, ResumeKeepsWhatIsRightAndMakesTheRestAnew) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4, 5, 6});
    job.png = true;
    run(scene, job);
    const auto whole = out.contents();

    job.resume = true;
    EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>(6, true));
    EXPECT_EQ(out.contents(), whole);

    // Missing, cut, damaged in its pixels, empty, and a PNG that is gone.
    std::filesystem::remove(out.file("f.0001.exr"));
    std::filesystem::resize_file(out.file("f.0002.exr"), whole.at("f.0002.exr").size() / 2);
    std::string damaged = whole.at("f.0003.exr");
    damaged[damaged.size() - 400] ^= 0x10;
    std::ofstream(out.file("f.0003.exr"), std::ios::binary) << damaged;
    std::filesystem::resize_file(out.file("f.0004.exr"), 0);
    std::filesystem::remove(out.file("f.0005.png"));
    EXPECT_EQ(kept_of(run(scene, job)), (std::vector<bool>{false, false, false, false, true, true}));
    EXPECT_EQ(out.contents(), whole);
}

// One byte of header, table or pixels.
TEST(Sequence, ResumeRendersAgainWhereAnyByteHasChanged) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, out.file("f.exr"), {1});
    job.resolution = {8, 6}, job.resume = true;
    run(scene, job);
    const std::string whole = out.contents().at("f.exr");
    for (size_t at = 0; at < whole.size(); at += 7) {
        std::string damaged = whole;
        damaged[at] ^= static_cast<char>(1 << (at % 8));
        std::ofstream(out.file("f.exr"), std::ios::binary) << damaged;
        ASSERT_EQ(kept_of(run(scene, job)), std::vector<bool>{false}) << "byte " << at;
    }
    EXPECT_EQ(out.contents().at("f.exr"), whole);
    EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>{true});
}

TEST(Sequence, ResumeRendersAgainWhatIsStale) {
    const TempFolder in, out;
    Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2});
    job.resume = true;
    run(scene, job);
    const auto expect_stale = [&](const char* what) {
        EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>(2, false)) << what;
        EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>(2, true)) << what;
    };
    EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>(2, true));
    job.seed = 1;
    expect_stale("seed");
    job.settings.march.step_depth = 0.123f;
    expect_stale("settings");
    job.resolution = {20, 30};
    expect_stale("resolution");
    job.crop_low = {1, 1}, job.crop_high = {9, 9};
    expect_stale("crop");
    job.isa = "avx512";
    expect_stale("instruction set");
    job.exr.layers = {"Z", "lights"};
    expect_stale("layers");
    job.exr.full_float = true;
    expect_stale("precision");
    std::ofstream(scene.file) << "{ }"; // after it was loaded: the frames are of what it was
    EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>(2, true));
    scene.inputs[0].hash = content_hash("{ }");
    expect_stale("scene file");
    scene.lights[0].intensity = Keyed<float>(683.0f);
    expect_stale("light units");
    scene.cameras[0].vertical_fov = Keyed<float>(0.5f);
    expect_stale("camera");
    scene.frame_rate = 30;
    expect_stale("frame rate");
}

TEST(Sequence, ResumeSeesChangedFogOfTheFrameAlone) {
    const TempFolder in, out;
    Scene scene = moving_scene(in);
    for (const char* name : {"fog.0001.vdb", "fog.0002.vdb"}) std::ofstream(in.file(name)) << name;
    MediumSource fog;
    fog.name = "cloud", fog.kind = MediumKind::vdb;
    fog.extinction = Keyed<float>(0.0f); // the volumes are hashed, not read
    fog.sequence.pattern = in.file("fog.####.vdb"), fog.sequence.files = {1, 2};
    scene.media.push_back(fog);
    RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2});
    job.resume = true;
    run(scene, job);
    EXPECT_EQ(kept_of(run(scene, job)), (std::vector<bool>{true, true}));
    std::ofstream(in.file("fog.0002.vdb")) << "other";
    EXPECT_EQ(kept_of(run(scene, job)), (std::vector<bool>{true, false}));
}

TEST(Sequence, MovingTheWholeProjectKeepsItsFrames) {
    const TempFolder here, there;
    Scene scene = moving_scene(here);
    run(scene, job_for(scene, here.file("f.exr"), {1}));
    std::filesystem::copy_file(here.file("f.exr"), there.file("g.exr"));
    scene = moving_scene(there);
    RenderRequest job = job_for(scene, there.file("g.exr"), {1});
    job.resume = true;
    EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>{true});
}
}

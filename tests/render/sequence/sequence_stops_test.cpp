// What stops a sequence keeps the frames before it whole; what cannot work is refused before any is rendered.
#include "base/error.h"
#include "base/io/file.h"
#include "modes/mode.h"
#include "render/sequence/sequence_fixtures.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "trace/view.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

namespace tyndall::test {
namespace {
ScatterFunction prepare_failing(const View& view, const Snapshot&, const Settings&, History*) {
    if (view.frame == 3) refuse("fog", "does not work");
    return [](const RayBatch&, std::span<Scatter> results) { std::ranges::fill(results, Scatter{}); };
}

std::atomic<bool>* cancel_from_mode = nullptr;
ScatterFunction prepare_cancelling(const View& view, const Snapshot&, const Settings&, History*) {
    return [frame = view.frame](const RayBatch&, std::span<Scatter> results) {
        if (frame == 3) *cancel_from_mode = true;
        std::ranges::fill(results, Scatter{});
    };
}

Progress* watched = nullptr;
double share_while_rendering = 0;
// Waits a moment for the two frames that are kept meanwhile.
ScatterFunction prepare_watching(const View& view, const Snapshot& snapshot, const Settings& settings, History* past) {
    for (int i = 0; i < 400 && watched->share() < 0.6; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    share_while_rendering = watched->share();
    return prepare_everything(view, snapshot, settings, past);
}
}

TEST(Sequence, AnErrorNamesItsFrameAndKeepsTheOnesBefore) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    const RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    const std::string text = error_message(ExitCode::refused, [&] { run(scene, job, mode_of(prepare_failing)); });
    EXPECT_EQ(text, "frame 3: fog: does not work");
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0001.exr", "f.0002.exr"}));
}

TEST(Sequence, AMissingVolumeNamesItsFrameAndKeepsTheOnesBefore) {
    const TempFolder in, out;
    Scene scene = moving_scene(in);
    MediumSource fog;
    fog.name = "cloud", fog.kind = MediumKind::vdb, fog.extinction = Keyed<float>(0.0f);
    for (const char* name : {"fog.0001.vdb", "fog.0002.vdb", "fog.0004.vdb"}) std::ofstream(in.file(name)) << name;
    fog.sequence.pattern = in.file("fog.####.vdb"), fog.sequence.files = {1, 2, 4};
    scene.media.push_back(fog);
    RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    const std::string text = error_message(ExitCode::unreadable, [&] { run(scene, job); });
    EXPECT_EQ(text.substr(0, 8), "frame 3:");
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0001.exr", "f.0002.exr"}));
    job.missing = MissingFrame::hold;
    EXPECT_EQ(run(scene, job).frames.size(), 4u);
}

TEST(Sequence, AFullDiskStopsAtTheFirstFrameItTakes) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    const RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string text = error_message(ExitCode::unwritable, [&] { run(scene, job); });
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(text.substr(0, 8), "frame 1:");
    EXPECT_TRUE(out.names().empty());
}

TEST(Sequence, CancellingKeepsWholeFramesOnly) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    const RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    Progress progress(ProgressStyle::none, "render", 4);
    std::atomic<bool> cancel = false;
    cancel_from_mode = &cancel;
    const Mode mode = mode_of(prepare_cancelling);
    const RenderReport report = render_sequence(scene, job, {&mode, job.settings, {}, {}, {}}, progress, cancel);
    EXPECT_TRUE(report.cancelled);
    EXPECT_EQ(report.frames.size(), 2u);
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0001.exr", "f.0002.exr"}));
    for (const std::string& name : out.names()) EXPECT_NO_THROW(read_exr(out.file(name)));
}

TEST(Sequence, ProgressCountsFramesThatAreDoneAndNoOther) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    RenderRequest job = job_for(scene, out.file("f.####.exr"), {1, 2, 3});
    run(scene, job);
    std::filesystem::remove(out.file("f.0001.exr"));
    job.resume = true;
    Progress progress(ProgressStyle::none, "render", 3);
    watched = &progress;
    std::atomic<bool> cancel = false;
    const Mode mode = mode_of(prepare_watching);
    const RenderReport report = render_sequence(scene, job, {&mode, job.settings, {}, {}, {}}, progress, cancel);
    EXPECT_EQ(std::ranges::count_if(report.frames, &FrameReport::kept), 2);
    EXPECT_LT(share_while_rendering, 0.7) << "one is not done";
    EXPECT_EQ(progress.share(), 1);
}

TEST(Sequence, RefusesWrongJobsBeforeAnyWork) {
    const TempFolder in, out;
    Scene scene = moving_scene(in);
    const RenderRequest good = job_for(scene, out.file("new/f.####.exr"), {1, 2});
    const auto expect_usage = [&](auto change, const std::string& reason) {
        RenderRequest job = good;
        change(job);
        const std::string text = error_message(ExitCode::usage, [&] { run(scene, job); });
        EXPECT_NE(text.find(reason), text.npos) << text;
        EXPECT_TRUE(out.names().empty()) << reason;
    };
    expect_usage([](RenderRequest& job) { job.frames.clear(); }, "nothing to render");
    expect_usage([&](RenderRequest& job) { job.output = out.file("f.exr"); }, "####");
    expect_usage([&](RenderRequest& job) { job.output = out.file("f.####.png"); }, ".exr");
    expect_usage([](RenderRequest& job) { job.exr.layers = {"depth"}; }, "depth");
    expect_usage([](RenderRequest& job) { job.resolution = {16385, 4}; }, "16384");
    expect_usage([](RenderRequest& job) { job.crop_low = {0, 0}, job.crop_high = {41, 30}; }, "crop");
    expect_usage([](RenderRequest& job) { job.crop_low = {5, 5}, job.crop_high = {4, 30}; }, "crop");
    expect_usage([](RenderRequest& job) { job.camera = "nobody"; }, "nobody");
}

TEST(Sequence, NeverWritesOverItsOwnScene) {
    const TempFolder in;
    Scene scene = moving_scene(in);
    std::ofstream(in.file("sky.exr")) << "sky";
    std::ofstream(in.file("wall.png")) << "wall";
    scene.inputs.push_back({in.path() / "." / "sky.exr", "sky"});
    scene.inputs.push_back({in.file("wall.png"), "wall"});
    error_message(ExitCode::usage, [&] { run(scene, job_for(scene, in.file("sky.exr"), {1})); });
    RenderRequest job = job_for(scene, in.file("wall.exr"), {1});
    job.png = true;
    error_message(ExitCode::usage, [&] { run(scene, job); });
    EXPECT_EQ(read_file(in.file("sky.exr")), "sky");
    EXPECT_EQ(read_file(in.file("wall.png")), "wall");
    job.png = false;
    EXPECT_EQ(run(scene, job).frames.size(), 1u);
}

TEST(Sequence, SaysAtOnceThatItCannotWrite) {
    const TempFolder in, out;
    const Scene scene = moving_scene(in);
    std::ofstream(out.file("file")) << "x";
    error_message(ExitCode::unwritable, [&] {
        run(scene, job_for(scene, out.file("file/f.####.exr"), {1, 2}), mode_of(prepare_failing));
    });
    std::filesystem::create_directories(out.path() / "f.0002.exr");
    error_message(ExitCode::unwritable, [&] { run(scene, job_for(scene, out.file("f.####.exr"), {1, 2})); });
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0002.exr", "file"}));
}
}

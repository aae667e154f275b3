#include "base/frames.h"
#include "base/json.h"
#include "base/parallel.h"
#include "fixtures.h"
#include "render/sequence.h"

#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

namespace tyndall::test {
namespace {
// A plane, a moving camera and fog; the scene file is in `directory`.
Scene moving_scene(const TemporaryDirectory& directory) {
    Scene scene;
    scene.file = directory.file("scene.json");
    std::ofstream(scene.file) << "{}";
    scene.inputs = {scene.file};
    scene.resolution = {40, 30};
    CameraSource camera;
    camera.name = "main";
    camera.position.times = {0, 1};
    camera.position.values = {vec3(0, 0, 0), vec3(1, 0.5f, 0)};
    camera.target.values = {vec3(0, 0, -5)};
    scene.cameras = {camera};
    add_plane(scene, -3, 1, vec3(2, 1, 0.5f));
    add_plane(scene, -2, 0.5f, vec3(0, 1, 0), 0.5f);
    MediumSource fog;
    fog.name = "haze";
    fog.extinction = Keyed<float>(0.2f);
    scene.media = {fog};
    LightSource light;
    light.name = "sun", light.kind = LightKind::sun;
    light.direction.values = {vec3(0, -1, -1)};
    scene.lights = {light};
    scene.background.color = Keyed<vec3>(vec3(0.1f, 0.2f, 0.4f));
    return scene;
}

RenderJob job_for(const Scene& scene, const std::string& output, std::vector<int> frames) {
    RenderJob job;
    job.scene_file = scene.file;
    job.output = output;
    job.frames = std::move(frames);
    job.mode = "test";
    job.settings = settings_for(Quality::draft);
    job.isa = "avx2";
    return job;
}

RenderReport run(const Scene& scene, const RenderJob& job, const Mode& mode = mode_of(prepare_everything)) {
    Progress progress(ProgressStyle::none, "render", static_cast<double>(job.frames.size()));
    std::atomic<bool> cancel = false;
    return render_sequence(scene, job, mode, progress, cancel);
}

std::map<std::string, std::string> files_of(const TemporaryDirectory& directory) {
    std::map<std::string, std::string> result;
    for (const std::string& name : directory.names())
        if (!std::filesystem::is_directory(directory.path / name)) result[name] = read_file(directory.path / name);
    return result;
}

std::vector<bool> kept_of(const RenderReport& report) {
    std::vector<bool> kept;
    for (const FrameReport& frame : report.frames) kept.push_back(frame.kept);
    return kept;
}
}

TEST(Sequence, WritesEveryFrame) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 5, -3});
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
    const TemporaryDirectory in, one, two;
    const Scene scene = moving_scene(in);
    RenderJob job = job_for(scene, one.file("f.####.exr"), {1, 2, 3, 4});
    job.png = true;
    set_thread_count(1);
    run(scene, job);
    set_thread_count(2);
    job.output = two.file("f.####.exr");
    run(scene, job);
    set_thread_count(0);
    EXPECT_EQ(files_of(one), files_of(two));
}

TEST(Sequence, FramesDoNotDependOnTheOthers) {
    const TemporaryDirectory in, all, single;
    const Scene scene = moving_scene(in);
    run(scene, job_for(scene, all.file("f.####.exr"), {1, 2, 3}));
    run(scene, job_for(scene, single.file("f.####.exr"), {3}));
    EXPECT_EQ(files_of(all)["f.0003.exr"], files_of(single)["f.0003.exr"]);
}

TEST(Sequence, SaysHowItWasMade) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    RenderJob job = job_for(scene, out.file("f.exr"), {12});
    job.settings.pixel.samples = 3;
    job.seed = 77;
    job.limits_said = {"info: one", "wrong: two"};
    run(scene, job);
    const auto attributes = read_exr(out.file("f.exr")).attributes;
    EXPECT_EQ(attributes.at("tyndall:mode"), "test");
    EXPECT_EQ(attributes.at("tyndall:scene"), "scene.json");
    EXPECT_EQ(attributes.at("tyndall:camera"), "main");
    EXPECT_EQ(attributes.at("tyndall:isa"), "avx2");
    EXPECT_EQ(attributes.at("tyndall:nonFinite"), "0");
    EXPECT_EQ(attributes.at("tyndall:limits"), "info: one\nwrong: two");
    EXPECT_EQ(attributes.at("imageCounter"), "12");
    EXPECT_EQ(attributes.at("tyndall:hash").size(), 32u);
    const std::string settings = attributes.at("tyndall:settings");
    for (const SettingRow& row : setting_rows())
        EXPECT_NE(settings.find(row.name + "=" + row.get(job.settings)), settings.npos) << row.name;
    const std::string command = attributes.at("tyndall:command");
    for (const char* part : {"--frames 12", "--seed 77", "--res 40x30", "--set pixel.samples=3", "--isa avx2"})
        EXPECT_NE(command.find(part), command.npos) << part << " in " << command;
    for (const auto& [name, text] : attributes) EXPECT_EQ(text.find(out.path.string()), text.npos) << name;
}

TEST(Sequence, ResumeKeepsWhatIsRightAndMakesTheRestAnew) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4, 5, 6});
    job.png = true;
    run(scene, job);
    const auto whole = files_of(out);

    job.resume = true;
    EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>(6, true));
    EXPECT_EQ(files_of(out), whole);

    // Missing, cut, damaged in its pixels, empty, and a PNG that is gone.
    std::filesystem::remove(out.file("f.0001.exr"));
    std::filesystem::resize_file(out.file("f.0002.exr"), whole.at("f.0002.exr").size() / 2);
    std::string damaged = whole.at("f.0003.exr");
    damaged[damaged.size() - 400] ^= 0x10;
    std::ofstream(out.file("f.0003.exr"), std::ios::binary) << damaged;
    std::filesystem::resize_file(out.file("f.0004.exr"), 0);
    std::filesystem::remove(out.file("f.0005.png"));
    EXPECT_EQ(kept_of(run(scene, job)), (std::vector<bool>{false, false, false, false, true, true}));
    EXPECT_EQ(files_of(out), whole);
}

TEST(Sequence, ResumeRendersAgainWhatIsStale) {
    const TemporaryDirectory in, out;
    Scene scene = moving_scene(in);
    RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2});
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
    std::ofstream(scene.file) << "{ }";
    expect_stale("scene file");
    scene.lights[0].intensity = Keyed<float>(683.0f);
    expect_stale("light units");
    scene.cameras[0].vertical_fov = Keyed<float>(0.5f);
    expect_stale("camera");
    scene.frame_rate = 30;
    expect_stale("frame rate");
}

TEST(Sequence, ResumeSeesChangedFogOfTheFrameAlone) {
    const TemporaryDirectory in, out;
    Scene scene = moving_scene(in);
    for (const char* name : {"fog.0001.vdb", "fog.0002.vdb"}) std::ofstream(in.file(name)) << name;
    MediumSource fog;
    fog.name = "cloud", fog.kind = MediumKind::vdb;
    fog.extinction = Keyed<float>(0.0f); // the volumes are hashed, not read
    fog.sequence.pattern = in.file("fog.####.vdb"), fog.sequence.files = {1, 2};
    scene.media.push_back(fog);
    scene.inputs.insert(scene.inputs.end(), {in.file("fog.0001.vdb"), in.file("fog.0002.vdb")});
    RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2});
    job.resume = true;
    run(scene, job);
    EXPECT_EQ(kept_of(run(scene, job)), (std::vector<bool>{true, true}));
    std::ofstream(in.file("fog.0002.vdb")) << "other";
    EXPECT_EQ(kept_of(run(scene, job)), (std::vector<bool>{true, false}));
}

TEST(Sequence, MovingTheWholeProjectKeepsItsFrames) {
    const TemporaryDirectory here, there;
    Scene scene = moving_scene(here);
    run(scene, job_for(scene, here.file("f.exr"), {1}));
    std::filesystem::copy_file(here.file("f.exr"), there.file("g.exr"));
    scene = moving_scene(there);
    RenderJob job = job_for(scene, there.file("g.exr"), {1});
    job.resume = true;
    EXPECT_EQ(kept_of(run(scene, job)), std::vector<bool>{true});
}

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

ScatterFunction prepare_not_finite(const View& view, const Snapshot&, const Settings&, History*) {
    return [frame = view.frame](const RayBatch&, std::span<Scatter> results) {
        for (Scatter& result : results) result = {vec3(frame == 2 ? NAN : 1), 1, 1, 0};
    };
}
}

TEST(Sequence, AnErrorNamesItsFrameAndKeepsTheOnesBefore) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    const RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    const std::string text = error_text(ExitCode::refused, [&] { run(scene, job, mode_of(prepare_failing)); });
    EXPECT_EQ(text, "frame 3: fog: does not work");
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0001.exr", "f.0002.exr"}));
}

TEST(Sequence, AMissingVolumeNamesItsFrameAndKeepsTheOnesBefore) {
    const TemporaryDirectory in, out;
    Scene scene = moving_scene(in);
    MediumSource fog;
    fog.name = "cloud", fog.kind = MediumKind::vdb, fog.extinction = Keyed<float>(0.0f);
    for (const char* name : {"fog.0001.vdb", "fog.0002.vdb", "fog.0004.vdb"}) std::ofstream(in.file(name)) << name;
    fog.sequence.pattern = in.file("fog.####.vdb"), fog.sequence.files = {1, 2, 4};
    scene.media.push_back(fog);
    RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    const std::string text = error_text(ExitCode::unreadable, [&] { run(scene, job); });
    EXPECT_EQ(text.substr(0, 8), "frame 3:");
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0001.exr", "f.0002.exr"}));
    job.missing = MissingFrame::hold;
    EXPECT_EQ(run(scene, job).frames.size(), 4u);
}

TEST(Sequence, AFullDiskStopsAtTheFirstFrameItTakes) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    const RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string text = error_text(ExitCode::unwritable, [&] { run(scene, job); });
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(text.substr(0, 8), "frame 1:");
    EXPECT_TRUE(out.names().empty());
}

TEST(Sequence, CancellingKeepsWholeFramesOnly) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    const RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3, 4});
    Progress progress(ProgressStyle::none, "render", 4);
    std::atomic<bool> cancel = false;
    cancel_from_mode = &cancel;
    const RenderReport report = render_sequence(scene, job, mode_of(prepare_cancelling), progress, cancel);
    EXPECT_TRUE(report.cancelled);
    EXPECT_EQ(report.frames.size(), 2u);
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0001.exr", "f.0002.exr"}));
    for (const std::string& name : out.names()) EXPECT_NO_THROW(read_exr(out.file(name)));
}

TEST(Sequence, ProgressCountsFramesThatAreDoneAndNoOther) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3});
    run(scene, job);
    std::filesystem::remove(out.file("f.0001.exr"));
    job.resume = true;
    Progress progress(ProgressStyle::none, "render", 3);
    watched = &progress;
    std::atomic<bool> cancel = false;
    const RenderReport report = render_sequence(scene, job, mode_of(prepare_watching), progress, cancel);
    EXPECT_EQ(std::ranges::count_if(report.frames, &FrameReport::kept), 2);
    EXPECT_LT(share_while_rendering, 0.7) << "one is not done";
    EXPECT_EQ(progress.share(), 1);
}

TEST(Sequence, CountsSamplesThatAreNotFinite) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    const RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3});
    const RenderReport report = run(scene, job, mode_of(prepare_not_finite));
    EXPECT_EQ(report.non_finite, 40u * 30);
    EXPECT_EQ(report.frames[1].stats.non_finite, 40u * 30);
    const auto attributes = read_exr(out.file("f.0002.exr")).attributes;
    EXPECT_EQ(attributes.at("tyndall:nonFinite"), "1200");
    EXPECT_EQ(attributes.at("tyndall:firstNonFinite"), "0,0");
}

TEST(Sequence, RefusesWrongJobsBeforeAnyWork) {
    const TemporaryDirectory in, out;
    Scene scene = moving_scene(in);
    const RenderJob good = job_for(scene, out.file("new/f.####.exr"), {1, 2});
    const auto expect_usage = [&](auto change, const std::string& reason) {
        RenderJob job = good;
        change(job);
        const std::string text = error_text(ExitCode::usage, [&] { run(scene, job); });
        EXPECT_NE(text.find(reason), text.npos) << text;
        EXPECT_TRUE(out.names().empty()) << reason;
    };
    expect_usage([](RenderJob& job) { job.frames.clear(); }, "nothing to render");
    expect_usage([&](RenderJob& job) { job.output = out.file("f.exr"); }, "####");
    expect_usage([&](RenderJob& job) { job.output = out.file("f.####.png"); }, ".exr");
    expect_usage([](RenderJob& job) { job.exr.layers = {"depth"}; }, "depth");
    expect_usage([](RenderJob& job) { job.resolution = {16385, 4}; }, "16384");
    expect_usage([](RenderJob& job) { job.crop_low = {0, 0}, job.crop_high = {41, 30}; }, "crop");
    expect_usage([](RenderJob& job) { job.crop_low = {5, 5}, job.crop_high = {4, 30}; }, "crop");
    expect_usage([](RenderJob& job) { job.camera = "nobody"; }, "nobody");
}

TEST(Sequence, NeverWritesOverItsOwnScene) {
    const TemporaryDirectory in;
    Scene scene = moving_scene(in);
    std::ofstream(in.file("sky.exr")) << "sky";
    std::ofstream(in.file("wall.png")) << "wall";
    scene.inputs.push_back(in.path / "." / "sky.exr");
    scene.inputs.push_back(in.file("wall.png"));
    error_text(ExitCode::usage, [&] { run(scene, job_for(scene, in.file("sky.exr"), {1})); });
    RenderJob job = job_for(scene, in.file("wall.exr"), {1});
    job.png = true;
    error_text(ExitCode::usage, [&] { run(scene, job); });
    EXPECT_EQ(read_file(in.file("sky.exr")), "sky");
    EXPECT_EQ(read_file(in.file("wall.png")), "wall");
    job.png = false;
    EXPECT_EQ(run(scene, job).frames.size(), 1u);
}

TEST(Sequence, SaysAtOnceThatItCannotWrite) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    std::ofstream(out.file("file")) << "x";
    error_text(ExitCode::unwritable, [&] {
        run(scene, job_for(scene, out.file("file/f.####.exr"), {1, 2}), mode_of(prepare_failing));
    });
    std::filesystem::create_directories(out.path / "f.0002.exr");
    error_text(ExitCode::unwritable, [&] { run(scene, job_for(scene, out.file("f.####.exr"), {1, 2})); });
    EXPECT_EQ(out.names(), (std::vector<std::string>{"f.0002.exr", "file"}));
}

TEST(Sequence, ReportsItselfAsJson) {
    const TemporaryDirectory in, out;
    const Scene scene = moving_scene(in);
    RenderJob job = job_for(scene, out.file("f.####.exr"), {1, 2, 3});
    const RenderReport report = run(scene, job, mode_of(prepare_not_finite));
    const Json json = parse_json(stats_json(report, job), "stats");
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
}

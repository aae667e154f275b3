#include "base/io/file.h"
#include "render/image/exr.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "trace/moment.h"
#include "viewer/editing/scene_loader.h"
#include "viewer/editing/scene_session.h"
#include "viewer/editing/scene_text.h"
#include "viewer/fixtures.h"
#include "viewer/painting/job_thread.h"
#include "viewer/painting/painting.h"
#include "viewer/painting/save_picture.h"
#include "viewer/state/edit_actions.h"
#include "viewer/state/view_state.h"
#include "volume/recipe/bake.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tyndall::test {
namespace {
// A scene of one sun over a patch of fog from a recipe, read from files.
struct FileJobs : testing::Test {
    TempFolder directory;
    ViewState state;
    std::atomic<bool> cancel{false};

    std::filesystem::path path(const char* name) const { return directory.path() / name; }

    void SetUp() override {
        std::ofstream(path("fog.json")) << R"({"bounds": {"low": [-1, -1, -1], "high": [1, 1, 1]}, "voxel_size": 0.25,
            "noise": {"octaves": 2, "scale": 1}, "density": {"threshold": 0.2}, "wind": [1, 0, 0]})";
        std::ofstream(path("scene.json")) << R"({"tyndall": 1, "resolution": [24, 16],
            "frames": "1-3", "frame_rate": 12,
            "camera": {"name": "eye", "position": [0, 0, 4], "target": [0, 0, 0], "vertical_fov": 40},
            "lights": [{"name": "sun", "type": "sun", "direction": [0.2, -1, 0], "intensity": 3}],
            "media": [{"name": "haze", "type": "homogeneous", "extinction": 0.1,
                       "bounds": {"low": [-1, -1, -1], "high": [1, 1, 1]}},
                      {"name": "wisps", "type": "noise", "recipe": "fog.json", "extinction": 0.7}]})";
        auto session = std::make_shared<SceneSession>(open_session(path("scene.json")));
        auto stage = std::make_shared<Scene>(session->scene);
        take_scene(state, {path("scene.json"), session, stage, {}, ExitCode::ok});
    }

    JobResult run(const FileJob& job) {
        Progress progress(ProgressStyle::silent, "job", frame_count(job));
        const JobResult result = run_job(job, progress, cancel);
        EXPECT_EQ(progress.share() == 1, result.code == ExitCode::ok) << result.message;
        return result;
    }
    RenderRequest sequence(const char* range, bool png = false) const {
        return sequence_request(state, path("out.####.exr"), range, png, "avx2");
    }
    RenderJob frames(const char* range, bool png = false) const { return render_job(state, sequence(range, png)); }
};

std::vector<float> pixels(const std::filesystem::path& file) {
    const Image<vec3> picture = color_of(read_exr(file));
    const float* values = &picture.pixels.front().x;
    return {values, values + 3 * picture.pixels.size()};
}
}

TEST_F(FileJobs, FramesAreThoseOfTheEditedSceneAndKeptWhenRight) {
    edit_scene(state, "lights/sun/intensity", "7", 0);
    const RenderJob files = frames("", true);
    EXPECT_EQ(files.request.frames, (std::vector<int>{1, 2, 3}));
    edit_scene(state, "lights/sun/intensity", "1", 0); // later edits are no matter of the job
    const JobResult result = run(files);
    EXPECT_EQ(result.code, ExitCode::ok);
    EXPECT_NE(result.message.find("3 frames rendered"), std::string::npos) << result.message;
    EXPECT_TRUE(exists(path("out.0002.png")));

    undo_edit(state);
    state.frame = 2;
    SaveJob single;
    single.file = path("single.exr"), single.request = request_of(state, false);
    single.isa = "avx2", single.unsaved = unsaved_text(*state.session);
    save_picture(single, nullptr, cancel, {});
    EXPECT_EQ(pixels(path("out.0002.exr")), pixels(path("single.exr")));
    const auto attributes = read_exr(path("out.0002.exr")).attributes;
    EXPECT_EQ(attributes.at("tyndall:unsavedEdits"), single.unsaved);
    EXPECT_EQ(attributes.at("tyndall:hash"), read_exr(path("single.exr")).attributes.at("tyndall:hash"));

    EXPECT_NE(run(frames("2-3", true)).message.find("0 frames rendered"), std::string::npos);
    edit_scene(state, "lights/sun/intensity", "2", 0);
    EXPECT_NE(run(frames("2-3")).message.find("2 frames rendered"), std::string::npos);
    EXPECT_NE(pixels(path("out.0002.exr")), pixels(path("single.exr")));
}

TEST_F(FileJobs, TheCameraMovedByHandCounts) {
    apply(state, parse_action("orbit 30 10"));
    const RenderJob files = frames("1");
    const Camera wanted = camera_now(state);
    const Camera made = camera_at(*files.scene, find_camera(*files.scene, files.request.camera), 0);
    EXPECT_LT(glm::distance(made.position, wanted.position), 1e-6f);
    EXPECT_LT(glm::distance(made.forward, wanted.forward), 1e-6f);
    EXPECT_LT(glm::distance(made.up, wanted.up), 1e-6f);
    EXPECT_EQ(made.vertical_fov, wanted.vertical_fov);
    EXPECT_EQ(run(files).code, ExitCode::ok);
}

TEST_F(FileJobs, FogIsThatOfTheMediumAsEdited) {
    edit_scene(state, "media/wisps/wind", "0 3 0", 0);
    EXPECT_EQ(bakeable_media(*state.scene), std::vector<std::string>{"wisps"});
    EXPECT_EQ(run(bake_job(state, "wisps", path("fog.####.vdb"), "5")).code, ExitCode::ok);
    FogRecipe recipe = read_recipe(path("fog.json"));
    recipe.wind = {0, 3, 0}, recipe.frame_rate = 12, recipe.extinction = 0.7f;
    Progress progress(ProgressStyle::silent, "bake", 1);
    bake(recipe, path("other.####.vdb"), {5}, {}, progress);
    EXPECT_TRUE(read_file(path("fog.0005.vdb")) == read_file(path("other.0005.vdb")));
}

TEST_F(FileJobs, MistakesSayWhatIsWrong) {
    const auto usage = [&](const auto& body) { return error_message(ExitCode::usage, body); };
    EXPECT_NE(usage([&] { frames("1-"); }).find("1-"), std::string::npos);
    EXPECT_NE(usage([&] { sequence_request(state, "out.exr", "", false, ""); }).find("####"), std::string::npos);
    EXPECT_NE(usage([&] { bake_job(state, "haze", "fog.####.vdb", ""); }).find("wisps"), std::string::npos);
    EXPECT_NE(usage([&] { bake_job(state, "wisps", "fog.exr", "1"); }).find(".vdb"), std::string::npos);
    std::ofstream(path("file")) << "in the way";
    EXPECT_EQ(run(render_job(state, sequence_request(state, path("file/out.####.exr"), "", false, ""))).code,
              ExitCode::unwritable);
    const std::string endless(300, 'a'); // longer than any file system's names
    EXPECT_EQ(run(render_job(state, sequence_request(state, path((endless + ".exr").c_str()), "1", false, ""))).code,
              ExitCode::unwritable);
    const ViewState empty;
    usage([&] { sequence_request(empty, "out.####.exr", "1", false, ""); });
}

TEST_F(FileJobs, TheCommandSaysWhatIsShown) {
    apply(state, parse_action("set march.step_depth 0.125"));
    apply(state, parse_action("quality final"));
    apply(state, parse_action("mode froxel"));
    apply(state, parse_action("set froxel.tile 4"));
    apply(state, parse_action("exposure 1"));
    const std::string command = command_of(state, sequence("1-3", true));
    for (const char* part : {"tyndall render ", "scene.json -o ", "out.####.exr' --frames 1-3 ", "--mode froxel ",
                             "--quality final ", "--set pixel.samples=16", "--set froxel.tile=4", "--png --exposure 1"})
        EXPECT_NE(command.find(part), std::string::npos) << command;
    EXPECT_EQ(command.find("march.step_depth"), std::string::npos) << command; // final's own again
    apply(state, parse_action("orbit 5 5"));
    error_message(ExitCode::usage, [&] { command_of(state, sequence("1")); });
    apply(state, parse_action("camera"));
    edit_scene(state, "lights/sun/intensity", "7", 0);
    error_message(ExitCode::usage, [&] { command_of(state, sequence("1")); });
}

TEST_F(FileJobs, AThreadDoesOneAtATimeAndStops) {
    std::atomic<int> news = 0;
    JobThread thread([&] { ++news; });
    EXPECT_FALSE(thread.status());
    state.mode = "path", state.settings.pixel.samples = 64;
    thread.start(frames("1-400"));
    ASSERT_TRUE(thread.status());
    EXPECT_EQ(thread.status()->frames, 400);
    error_message(ExitCode::usage, [&] { thread.start(frames("1")); });
    EXPECT_TRUE(eventually([&] { return thread.status()->share > 0; }));
    thread.stop();
    const std::optional<JobStatus> status = thread.status();
    EXPECT_TRUE(status && status->stopping); // until the result is taken
    std::optional<JobResult> result;
    ASSERT_TRUE(eventually([&] { return (result = thread.take_result()).has_value(); }));
    EXPECT_NE(result->message.find("stopped"), std::string::npos) << result->message;
    EXPECT_NE(result->message.find("of 400 frames"), std::string::npos) << result->message;
    EXPECT_FALSE(thread.status());
    EXPECT_TRUE(eventually([&] { return news == 1; }));
    for (const auto& entry : std::filesystem::directory_iterator(directory.path()))
        if (entry.path().extension() == ".exr") read_exr(entry.path()); // throws when it is partial

    state.settings.pixel.samples = 1;
    thread.start(frames("1"));
    ASSERT_TRUE(eventually([&] { return (result = thread.take_result()).has_value(); }));
    EXPECT_EQ(result->code, ExitCode::ok) << result->message;
}

TEST_F(FileJobs, AWindowThatClosesAsksAboutTheJob) {
    state.job = JobStatus{"render out.####.exr", 10};
    apply(state, parse_action("close"));
    EXPECT_TRUE(state.asked);
    EXPECT_FALSE(state.closing);
    apply(state, parse_action("answer cancel"));
    EXPECT_FALSE(state.closing);
    apply(state, parse_action("close"));
    apply(state, parse_action("answer discard"));
    EXPECT_TRUE(state.closing);
}
}

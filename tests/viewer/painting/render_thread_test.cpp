#include "base/clock.h"
#include "viewer/editing/scene_loader.h"
#include "viewer/fixtures.h"
#include "viewer/painting/painting.h"
#include "viewer/painting/render_thread.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

namespace tyndall::test {
namespace {
using namespace std::chrono_literals;

// Pictures until one is finished.
std::shared_ptr<const ShownPicture> finished(RenderThread& thread, uint64_t revision) {
    std::shared_ptr<const ShownPicture> picture;
    eventually([&] {
        if (auto newer = thread.take_picture()) picture = newer;
        return picture && picture->finished && picture->revision == revision;
    });
    return picture;
}
}

TEST(RenderThread, TheNewestRequestIsFinished) {
    std::atomic<int> news = 0;
    RenderThread thread([&] { ++news; });
    EXPECT_TRUE(thread.idle());
    Request request = request_for(small_scene());
    for (request.revision = 1; request.revision < 20; ++request.revision) {
        request.frame = static_cast<int>(request.revision);
        thread.post(request);
    }
    request.frame = 2;
    thread.post(request);
    EXPECT_FALSE(thread.idle());
    const auto picture = finished(thread, 20);
    ASSERT_TRUE(picture && picture->finished);
    EXPECT_EQ(picture->frame, 2);
    EXPECT_EQ(picture->samples, request.max_samples);
    EXPECT_TRUE(eventually([&] { return thread.idle(); }));
    EXPECT_GT(news, 0);
}

TEST(RenderThread, PostingNeverWaits) {
    RenderThread thread;
    Request request = request_for(small_scene(), "path");
    request.size = {640, 400}, request.max_samples = 1 << 20; // takes for ever
    thread.post(request);
    EXPECT_TRUE(eventually([&] { return thread.take_picture() != nullptr; }));
    double longest = 0;
    for (int i = 0; i < 100; ++i) {
        const double start = steady_seconds();
        ++request.revision;
        thread.post(request);
        thread.take_picture();
        longest = std::max(longest, steady_seconds() - start);
    }
    // A round of this picture takes a hundred times as long, on a busy machine too.
    EXPECT_LT(longest, 0.1);
}

TEST(RenderThread, MovingRequestsDoNotStarve) {
    RenderThread thread;
    Request request = request_for(small_scene());
    request.size = {640, 400}, request.moving = true;
    int pictures = 0;
    for (int i = 0; i < 400 && pictures < 5; ++i) {
        ++request.revision;
        thread.post(request);
        pictures += thread.take_picture() != nullptr;
        std::this_thread::sleep_for(5ms);
    }
    EXPECT_GE(pictures, 5);
    EXPECT_GE(thread.counts().quick, 5);
}

TEST(RenderThread, WritesFilesAndSaysWhatWentWrong) {
    TempFolder directory;
    RenderThread thread;
    SaveJob save;
    save.request = request_for(small_scene());
    save.file = directory.path() / "a.png";
    thread.save(save);
    save.file = "/proc/nowhere/a.png";
    thread.save(save);
    std::vector<SaveResult> saved;
    eventually([&] {
        if (auto one = thread.take_saved()) saved.push_back(*one);
        return saved.size() == 2;
    });
    ASSERT_EQ(saved.size(), 2u);
    EXPECT_EQ(saved[0].error, "");
    EXPECT_TRUE(std::filesystem::exists(directory.path() / "a.png"));
    EXPECT_EQ(static_cast<int>(saved[1].code), static_cast<int>(ExitCode::unwritable));
    EXPECT_TRUE(eventually([&] { return thread.idle(); }));
}

TEST(SceneLoader, ReadsBesideAndSaysWhatWentWrong) {
    SceneLoader loader;
    EXPECT_FALSE(loader.take());
    std::atomic<int> done = 0;
    loader.start(TYNDALL_SOURCE_DIR "/scenes/pillars.json", {}, [&] { ++done; });
    loader.start(TYNDALL_SOURCE_DIR "/scenes/window.json", {}, [&] { ++done; }); // forgets the first
    std::optional<LoadedScene> loaded;
    ASSERT_TRUE(eventually([&] { return (loaded = loader.take()).has_value(); }));
    ASSERT_TRUE(loaded->session);
    EXPECT_EQ(loaded->session->scene.file.filename(), "window.json");
    EXPECT_FALSE(loader.loading());
    loader.start("/nowhere.json", {});
    ASSERT_TRUE(eventually([&] { return (loaded = loader.take()).has_value(); }));
    EXPECT_FALSE(loaded->session);
    EXPECT_EQ(static_cast<int>(loaded->code), static_cast<int>(ExitCode::unreadable));
    EXPECT_TRUE(eventually([&] { return done == 2; }));
}

TEST(SceneLoader, FilesAreKnownAsTheyWereRead) {
    TempFolder directory;
    const std::filesystem::path file = directory.path() / "a.json";
    std::ofstream(file) << R"({"tyndall": 1, "camera": {"position": [0, 0, 1], "target": [0, 0, 0]}})";
    const auto now = std::filesystem::file_time_type::clock::now();
    for (const auto written : {now - 1min, now + 1min}) { // the clock of a file server may be ahead
        std::filesystem::last_write_time(file, written);
        SceneLoader loader;
        std::optional<LoadedScene> loaded;
        loader.start(file, {});
        ASSERT_TRUE(eventually([&] { return (loaded = loader.take()).has_value(); }));
        ASSERT_EQ(loaded->error, "");
        EXPECT_TRUE(changed_inputs(loaded->session->inputs).empty());
        std::filesystem::last_write_time(file, written + 1s);
        EXPECT_EQ(changed_inputs(loaded->session->inputs).size(), 1u);
    }
}
}

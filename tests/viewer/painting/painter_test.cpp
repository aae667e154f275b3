#include "base/io/file.h"
#include "base/io/progress.h"
#include "base/parallel.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "render/image/png.h"
#include "render/sequence/sequence.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "viewer/painting/painting.h"
#include "viewer/painting/save_picture.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tyndall::test {
namespace {
// The codes of one render with so many samples.
Image<glm::u8vec4> rendered(const Request& request, int samples) {
    flush_denormals();
    View view = view_of(request);
    view.pixel_samples = samples;
    const Snapshot snapshot = make_snapshot(*request.scene, moment_of(*request.scene, request.frame));
    FrameStats stats;
    return tone_map(render_frame(find_mode(request.mode), view, snapshot, request.settings, {}, stats), request.shown);
}

}

TEST(Painter, StillPicturesBecomeBetterUntilTheyAreFinished) {
    flush_denormals();
    Painter painter;
    const Request request = request_for(small_scene());
    const std::vector<ShownPicture> pictures = paint_all(painter, request);
    ASSERT_GE(pictures.size(), 4u);
    EXPECT_EQ(pictures[0].mode, "froxel"); // the stand-in, whole
    EXPECT_EQ(pictures[0].codes.size, request.size);
    for (size_t i = 1; i < pictures.size(); ++i) {
        EXPECT_EQ(pictures[i].mode, "march");
        EXPECT_GE(pictures[i].samples, pictures[i - 1].samples);
        EXPECT_EQ(pictures[i].finished, i + 1 == pictures.size());
    }
    EXPECT_EQ(pictures[1].samples, 1);
    EXPECT_EQ(pictures.back().samples, request.max_samples);
    EXPECT_FALSE(paint(painter, request, never));
}

TEST(Painter, TheRoundOfTheSettingsSamplesIsThePictureOfRender) {
    Painter painter;
    Request request = request_for(small_scene());
    request.max_samples = request.settings.pixel.samples;
    for (const char* mode : {"march", "froxel", "path", "radial-blur", "cone"}) {
        ++request.revision;
        request.mode = mode;
        const std::vector<ShownPicture> pictures = paint_all(painter, request);
        EXPECT_EQ(pictures.back().codes.pixels, rendered(request, request.settings.pixel.samples).pixels) << mode;
    }
}

TEST(Painter, TwoModesShareThePictureAtTheWipe) {
    Painter painter;
    Request request = request_for(small_scene());
    request.max_samples = request.settings.pixel.samples;
    request.beside = "cone", request.shown.wipe = 0.25f;
    const ShownPicture both = paint_all(painter, request).back();
    EXPECT_EQ(both.beside, "cone");
    EXPECT_EQ(both.samples, request.max_samples);
    Request other = request;
    other.mode = "cone";
    const auto left = rendered(request, request.max_samples), right = rendered(other, request.max_samples);
    ASSERT_NE(left.pixels, right.pixels);
    const auto is_composed = [&](const Image<glm::u8vec4>& codes, int split) {
        for (int y = 0; y < codes.size.y; ++y)
            for (int x = 0; x < codes.size.x; ++x)
                if (codes.at(x, y) != (x < split ? left : right).at(x, y)) return false;
        return true;
    };
    EXPECT_TRUE(is_composed(both.codes, request.size.x / 4));
    ++request.shown_revision, request.shown.wipe = 0.75f;
    EXPECT_TRUE(is_composed(paint(painter, request, never)->codes, 3 * request.size.x / 4));
    EXPECT_FALSE(paint(painter, request, never));
}

TEST(Painter, MovingPicturesAreQuickAndOneForEachRequest) {
    flush_denormals();
    Painter painter;
    Request request = request_for(small_scene());
    request.moving = true;
    const auto picture = paint(painter, request, never);
    ASSERT_TRUE(picture);
    EXPECT_TRUE(picture->quick);
    EXPECT_EQ(picture->mode, "froxel");
    EXPECT_LT(picture->codes.size.x, request.size.x);
    EXPECT_EQ(picture->wanted, request.size);
    EXPECT_FALSE(paint(painter, request, never));
    request.moving = false;
    EXPECT_EQ(paint_all(painter, request).back().samples, request.max_samples);
}

TEST(Painter, ExposureShowsTheSameSamplesAnew) {
    flush_denormals();
    Painter painter;
    Request request = request_for(small_scene());
    const ShownPicture before = paint_all(painter, request).back();
    ++request.shown_revision, request.shown.exposure = 2;
    const auto after = paint(painter, request, never);
    ASSERT_TRUE(after);
    EXPECT_EQ(after->samples, before.samples);
    EXPECT_TRUE(after->finished);
    EXPECT_NE(after->codes.pixels, before.codes.pixels);
    EXPECT_FALSE(paint(painter, request, never));
}

TEST(Painter, WhatWasPaintedBeforeLeavesNoTrace) {
    flush_denormals();
    const auto scene = small_scene();
    Request last = request_for(scene);
    last.revision = 9, last.frame = 3, last.camera = camera_at(*scene, 1, moment_of(*scene, 3).seconds);
    Painter fresh, used;
    Request other = request_for(scene);
    paint_all(used, other);
    other.revision = 2, other.moving = true, other.frame = 2;
    paint(used, other, never);
    other.revision = 3, other.mode = "path", other.moving = false;
    paint(used, other, never);
    const std::vector<ShownPicture> a = paint_all(fresh, last), b = paint_all(used, last);
    // Rounds depend on the time they take but for the first ones.
    EXPECT_EQ(a[1].codes.pixels, b[1].codes.pixels);
    EXPECT_EQ(a[2].codes.pixels, b[2].codes.pixels);
}

TEST(Painter, MistakesOfTheSceneAreSaidAndThePainterGoesOn) {
    Painter painter;
    Scene broken = *small_scene();
    broken.lights[0].direction = Keyed<vec3>(vec3(0));
    const auto picture = paint(painter, request_for(std::make_shared<Scene>(broken)), never);
    ASSERT_TRUE(picture);
    EXPECT_NE(picture->error.find("its direction is zero"), std::string::npos) << picture->error;
    EXPECT_EQ(static_cast<int>(picture->code), static_cast<int>(ExitCode::refused));
    EXPECT_TRUE(picture->codes.empty());
    EXPECT_EQ(paint_all(painter, request_for(small_scene())).back().error, "");
}

TEST(Painter, CancelledWorkComesToNothing) {
    Painter painter;
    std::atomic<bool> now = true;
    const Request request = request_for(small_scene());
    EXPECT_FALSE(paint(painter, request, now));
    EXPECT_EQ(paint_all(painter, request).back().samples, request.max_samples);
}

TEST(Painter, APictureThatNeverBeganIsNotShownAnew) {
    Painter painter;
    Request request = request_for(small_scene());
    paint_all(painter, request);
    std::atomic<bool> cancelled{true};
    ++request.revision;
    EXPECT_FALSE(paint(painter, request, cancelled));
    ++request.shown_revision, request.shown.exposure = 1;
    const auto picture = paint(painter, request, never);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->mode, "froxel");
    EXPECT_EQ(picture->samples, 1);
}

TEST(Painter, AStillPictureThatHasBegunIsNotReplacedByAQuickOne) {
    Painter painter;
    Request request = request_for(small_scene());
    request.mode = "froxel", request.beside = "shadow-map", request.max_samples = 8;
    painter.paces["froxel"].level = 3; // quick pictures are small
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(paint(painter, request, never));
    Request moving = request;
    moving.moving = true;
    EXPECT_FALSE(paint(painter, moving, never));
    const std::vector<ShownPicture> rest = paint_all(painter, request);
    ASSERT_FALSE(rest.empty());
    EXPECT_EQ(rest.back().codes.size, request.size);
    EXPECT_EQ(rest.back().beside, "shadow-map");
    EXPECT_EQ(painter.rounds[0].layers.color.size, request.size);
}

TEST(SavePicture, FilesAreThoseOfRender) {
    flush_denormals();
    TempFolder directory;
    const std::filesystem::path file = directory.path() / "scene.json";
    std::ofstream(file) << "{}";
    Scene copy = *small_scene(file);
    copy.inputs = {{file, content_hash("{}")}};
    const auto scene = std::make_shared<Scene>(copy);
    for (const char* mode : {"march", "froxel", "path"}) {
        SaveJob save;
        save.request = request_for(scene, mode), save.request.shown.exposure.reset();
        save.isa = "avx2";
        Painter painter; // with something before
        paint_all(painter, save.request);
        for (const char* name : {"a.exr", "a.png"}) {
            save.file = directory.path() / name;
            save_picture(save, &painter.snapshot, never, {});
        }
        RenderRequest job;
        job.scene_file = file, job.output = (directory.path() / "b.exr").string(), job.frames = {1};
        job.mode = mode, job.settings = settings_for(Quality::preview), job.isa = "avx2", job.png = true;
        Progress progress(ProgressStyle::silent, "render", 1);
        render_sequence(*scene, job, requested_plan(job), progress, never);
        // The size is the scene's either way; only the command in the header spells it out, and the name of the file.
        const auto nameless = [&](const char* name) {
            return without_names(bytes_of(directory.path() / name), {name});
        };
        EXPECT_EQ(nameless("a.exr"), nameless("b.exr")) << mode;
        EXPECT_EQ(bytes_of(directory.path() / "a.png"), bytes_of(directory.path() / "b.png")) << mode;
    }
}

TEST(SavePicture, RefusesOtherKindsAndTheScenesOwnFiles) {
    TempFolder directory;
    Scene copy = *small_scene();
    copy.inputs = {{directory.path() / "plate.png", "x"}};
    std::ofstream(copy.inputs[0].path) << "x";
    SaveJob save;
    save.request = request_for(std::make_shared<Scene>(copy));
    save.file = directory.path() / "a.jpg";
    error_message(ExitCode::usage, [&] { save_picture(save, nullptr, never, {}); });
    save.file = copy.inputs[0].path;
    error_message(ExitCode::usage, [&] { save_picture(save, nullptr, never, {}); });
    save.file = "/proc/nowhere/a.exr";
    error_message(ExitCode::unwritable, [&] { save_picture(save, nullptr, never, {}); });
}
}

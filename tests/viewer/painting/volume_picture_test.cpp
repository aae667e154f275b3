#include "base/parallel.h"
#include "measure/metrics/heatmap.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "viewer/painting/painting.h"
#include "viewer/state/view_state.h"
#include "volume/medium.h"
#include "volume/vdb/vdb.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall::test {
namespace {
VolumePicture asked(const Request& request) {
    flush_denormals();
    const Snapshot snapshot = make_snapshot(*request.scene, moment_of(*request.scene, request.frame));
    KnownVolumes known;
    return *volume_picture(request, snapshot, known);
}

// 16 x 8 x 8 voxels of 0.5 m, centers of the first at 0.25: the density rises along x only, 0 to 15 sixteenths.
std::shared_ptr<Scene> scene_with_ramp(const TempFolder& directory) {
    SparseVolume volume;
    volume.index_to_world = glm::translate(dmat4(1), dvec3(0.25)) * glm::scale(dmat4(1), dvec3(0.5));
    volume.active_low = ivec3(0), volume.active_high = ivec3(15, 7, 7);
    for (int leaf = 0; leaf < 2; ++leaf) {
        Leaf& one = volume.leaves.emplace_back();
        one.origin = ivec3(8 * leaf, 0, 0);
        for (int i = 0; i < 512; ++i) one.values[static_cast<size_t>(i)] = static_cast<float>(8 * leaf + i / 64) / 16;
    }
    write_vdb(directory.path() / "ramp.vdb", volume);
    Scene scene = *small_scene(directory.path() / "scene.json");
    scene.media[0].name = "ramp", scene.media[0].kind = MediumKind::vdb;
    scene.media[0].sequence = find_sequence("ramp.vdb", directory.path());
    return std::make_shared<Scene>(std::move(scene));
}

std::string fact(const VolumePicture& shown, const std::string& name) {
    for (const auto& [key, value] : shown.facts)
        if (key == name) return value;
    return "none";
}

double lightness(glm::u8vec4 code) { return 0.2126 * code.x + 0.7152 * code.y + 0.0722 * code.z; }
}

TEST(VolumePicture, ASliceShowsTheDensityWhereItIs) {
    const TempFolder directory;
    Request request = request_for(scene_with_ramp(directory));
    request.volume = VolumeRequest{"ramp", VolumeLook::slice, 2, 0.5f};
    const VolumePicture shown = asked(request);
    EXPECT_EQ(shown.medium, "ramp");
    EXPECT_EQ(shown.right, 0);
    EXPECT_EQ(shown.up, 1);
    EXPECT_NEAR(shown.place, 2, 0.3);
    EXPECT_EQ(shown.high, 15.0 / 16);
    ASSERT_GE(shown.codes.size.x, 15);
    const int row = shown.codes.size.y / 2;
    const auto color_at = [&](double x) { // meters
        const double share = (x - shown.box.low.x) / (shown.box.high.x - shown.box.low.x);
        return shown.codes.at(static_cast<int>(share * shown.codes.size.x), row);
    };
    EXPECT_LT(lightness(color_at(1)), lightness(color_at(4)));
    EXPECT_LT(lightness(color_at(4)), lightness(color_at(7)));
    // A cell is half a meter wide at most, and the density rises by an eighth per meter.
    const double least = (7 - 0.25 - 0.5) / 8 / shown.high, most = (7 - 0.25 + 0.5) / 8 / shown.high;
    EXPECT_GE(lightness(color_at(7)), lightness({heat_color(least), 255}));
    EXPECT_LE(lightness(color_at(7)), lightness({heat_color(most), 255}));
}

TEST(VolumePicture, MaximumAndMeanAreAlongTheAxis) {
    const TempFolder directory;
    Request request = request_for(scene_with_ramp(directory));
    request.volume = VolumeRequest{"", VolumeLook::maximum, 0, 0};
    const VolumePicture most = asked(request);
    EXPECT_EQ(most.right, 2);
    const glm::u8vec4 middle = most.codes.at(most.codes.size.x / 2, most.codes.size.y / 2);
    EXPECT_GT(lightness(middle), lightness({heat_color(0.9), 255}));
    request.volume->look = VolumeLook::mean;
    const VolumePicture mean = asked(request);
    EXPECT_NEAR(mean.high, 7.5 / 16, 0.06); // even across: of 0 to 15 sixteenths, and the slope at both ends
}

TEST(VolumePicture, FactsAreThoseOfTyndallInfo) {
    const TempFolder directory;
    Request request = request_for(scene_with_ramp(directory));
    request.volume = VolumeRequest{};
    const VolumePicture shown = asked(request);
    EXPECT_EQ(fact(shown, "file"), "ramp.vdb");
    EXPECT_NE(fact(shown, "grid").find("density: float, fog volume, usable as fog"), std::string::npos);
    EXPECT_NE(fact(shown, "active").find("960 voxels in 2 leaves"), std::string::npos) << fact(shown, "active");
    EXPECT_NE(fact(shown, "extent").find("15 x 8 x 8 voxels of 0.5 0.5 0.5 m"), std::string::npos)
        << fact(shown, "extent");
    EXPECT_NE(fact(shown, "values").find("to 0.9375"), std::string::npos) << fact(shown, "values");
}

TEST(VolumePicture, EvenFogAndNoFogAreShownToo) {
    Request request = request_for(small_scene());
    request.volume = VolumeRequest{"haze", VolumeLook::slice, 1, 0.25f};
    const VolumePicture even = asked(request);
    EXPECT_EQ(even.box.low, vec3(-3));
    EXPECT_NEAR(even.place, -1.5, 1e-6);
    for (const glm::u8vec4& code : even.codes.pixels) EXPECT_EQ(code, glm::u8vec4(255));
    Scene clear = *small_scene();
    clear.media[0].extinction = Keyed<float>(0);
    request.scene = std::make_shared<Scene>(clear);
    const VolumePicture none = asked(request);
    EXPECT_TRUE(none.codes.empty());
    EXPECT_EQ(none.remark, "haze has no fog at this moment");
}

TEST(VolumePicture, ComesWithThePictureAndFollowsTheQuestion) {
    flush_denormals();
    Painter painter;
    Request request = request_for(small_scene(), "cone");
    request.max_samples = 1, request.volume = VolumeRequest{};
    const auto first = paint(painter, request, never);
    ASSERT_TRUE(first && first->volume);
    EXPECT_EQ(first->volume->question.axis, 2);
    ++request.shown_revision, request.volume->axis = 0;
    EXPECT_EQ(paint(painter, request, never)->volume->question.axis, 0);
    ++request.revision, request.moving = true, request.frame = 2;
    const auto quick = paint(painter, request, never);
    EXPECT_EQ(quick->volume->frame, 2) << "follows the time";
    EXPECT_TRUE(quick->volume->quick);
    request.moving = false;
    EXPECT_FALSE(paint(painter, request, never)->volume->quick);
}

TEST(VolumePicture, LooksAreActions) {
    ViewState state;
    take_scene(state, small_scene());
    const uint64_t revision = state.revision;
    EXPECT_FALSE(request_of(state, false).volume);
    apply(state, parse_action("slice y 0.25"));
    EXPECT_EQ(*request_of(state, false).volume, (VolumeRequest{"", VolumeLook::slice, 1, 0.25f}));
    apply(state, parse_action("project x mean"));
    EXPECT_EQ(*request_of(state, false).volume, (VolumeRequest{"", VolumeLook::mean, 0, 0.25f}));
    apply(state, parse_action("medium haze"));
    EXPECT_EQ(request_of(state, false).volume->medium, "haze");
    EXPECT_NE(
        error_message(ExitCode::usage, [&] { apply(state, parse_action("medium smoke")); }).find("available: haze"),
        std::string::npos);
    apply(state, parse_action("volume off"));
    EXPECT_FALSE(request_of(state, false).volume);
    EXPECT_EQ(state.revision, revision) << "the picture stays";
    error_message(ExitCode::refused, [] { parse_action("slice w 0.5"); });
    error_message(ExitCode::refused, [] { parse_action("project x least"); });
}
}

#include "base/parallel.h"
#include "measure/explain/curves.h"
#include "modes/mode.h"
#include "scene/light.h"
#include "viewer/painting/painting.h"
#include "viewer/state/view_state.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
Request ray_request() {
    flush_denormals();
    Request request = request_for(small_scene(), "cone");
    request.max_samples = 2, request.explain = ivec2(32, 20);
    return request;
}
}

TEST(RayQuestion, IsAnsweredAsTyndallExplainDoes) {
    Painter painter;
    const Request request = ray_request();
    const std::vector<ShownPicture> pictures = paint_all(painter, request);
    ASSERT_FALSE(pictures[0].ray) << "a picture comes first";
    ASSERT_TRUE(pictures[1].ray);
    EXPECT_FALSE(pictures[1].ray->complete) << "the curves come before the techniques";
    EXPECT_TRUE(pictures[1].ray->report.results.empty());
    const auto answer = pictures.back().ray;
    ASSERT_TRUE(answer && answer->complete);
    EXPECT_EQ(answer->pixel, ivec2(32, 20));

    const Snapshot snapshot = make_snapshot(*request.scene, moment_of(*request.scene, 1));
    ExplainOptions options;
    for (const Mode& mode : modes()) options.modes.push_back(&mode);
    const RayReport report = explain_ray(view_of(request), snapshot, request.settings, {32, 20}, options);
    EXPECT_EQ(answer->report.reference.inscatter, report.reference.inscatter);
    EXPECT_GT(report.reference.inscatter.x, 0);
    ASSERT_EQ(answer->report.results.size(), modes().size());
    for (size_t i = 0; i < modes().size(); ++i) {
        if (is_unbiased(modes()[i])) continue;
        EXPECT_EQ(answer->report.results[i].inscatter, report.results[i].inscatter) << modes()[i].name;
    }
}

TEST(RayQuestion, FollowsTheFrameAndTheCameraAndIsNotAskedTwice) {
    Painter painter;
    Request request = ray_request();
    const auto first = paint_all(painter, request).back().ray;
    ++request.shown_revision, request.shown.exposure = 1;
    EXPECT_EQ(paint_all(painter, request).back().ray, first);
    ++request.revision, request.frame = 3, request.camera = camera_at(*request.scene, 1, 0);
    const std::vector<ShownPicture> later = paint_all(painter, request);
    EXPECT_EQ(later.back().ray->frame, 3);
    EXPECT_NE(later.back().ray->report.origin, first->report.origin);
    ++request.shown_revision, request.explain = ivec2(0, 0);
    EXPECT_EQ(paint_all(painter, request).back().ray->pixel, ivec2(0, 0));
    ++request.shown_revision, request.explain.reset();
    EXPECT_FALSE(paint_all(painter, request).back().ray);
}

TEST(RayQuestion, QuickPicturesDoNotWaitForIt) {
    Painter painter;
    Request request = ray_request();
    request.moving = true;
    const std::vector<ShownPicture> pictures = paint_all(painter, request);
    EXPECT_EQ(pictures.size(), 1u);
    EXPECT_FALSE(painter.ray);
}

TEST(RayQuestion, ExplainIsAnActionWithAPixelOfThePicture) {
    ViewState state;
    error_message(ExitCode::usage, [&] { apply(state, parse_action("explain 3 4")); });
    take_scene(state, small_scene());
    apply(state, parse_action("explain 63 39.7"));
    EXPECT_EQ(request_of(state, false).explain, ivec2(63, 39));
    const uint64_t revision = state.revision;
    for (const char* line : {"explain 64 0", "explain 0 40", "explain -1 0"})
        EXPECT_NE(error_message(ExitCode::usage, [&] { apply(state, parse_action(line)); }).find("outside"),
                  std::string::npos);
    EXPECT_EQ(request_of(state, false).explain, ivec2(63, 39));
    apply(state, parse_action("explain"));
    EXPECT_FALSE(request_of(state, false).explain);
    EXPECT_EQ(state.revision, revision) << "the picture stays";
    EXPECT_NE(error_message(ExitCode::refused, [] { parse_action("explain 3"); }).find("expected explain x y"),
              std::string::npos);
}

TEST(RayCurves, LightsAreTheBrightestOnesInTheirOrder) {
    RayReport report;
    for (const float brightness : {1.0f, 3.0f, 0.5f, 2.0f}) {
        LightOnRay light;
        light.fog = vec3(brightness);
        report.lights.push_back(light);
    }
    EXPECT_EQ(ray_drawing::brightest_lights(report, 2), (std::vector<size_t>{1, 3}));
    EXPECT_EQ(ray_drawing::brightest_lights(report, 9).size(), 4u);
}
}

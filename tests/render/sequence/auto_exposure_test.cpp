// The exposure of PNGs that nobody set.
#include "modes/mode.h"
#include "render/sequence/auto_exposure.h"
#include "render/sequence/sequence_fixtures.h"
#include "scene/scene.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// A picture whose stops lie evenly around a middle.
std::vector<float> spread(float middle, float stops, size_t count = 2000) {
    std::vector<float> values(count);
    for (size_t i = 0; i < count; ++i)
        values[i] = middle * std::exp2(stops * (static_cast<float>(i) / static_cast<float>(count - 1) - 0.5f));
    return values;
}

struct Bench {
    TempFolder directory;
    Scene scene = moving_scene(directory);
    RenderRequest request = job_for(scene, directory.file("f.####.exr"), {1});

    double exposure(int orders = 1) const { return automatic_exposure(scene, request, orders); }
};
}

TEST(AutoExposure, ShowsTheMiddleOfAPictureAsGray) {
    for (const float stops : {0.0f, 2.0f, 5.0f, 9.0f}) {
        const double exposure = exposure_for(spread(1, stops)).value();
        const float shown = display_value(vec3(1), {exposure}).x;
        EXPECT_GT(shown, 30) << stops;
        EXPECT_LT(shown, 215) << stops;
        EXPECT_LT(display_value(vec3(std::exp2(0.5f * stops)), {exposure}).x, 246) << stops;
    }
}

TEST(AutoExposure, FollowsTheLightStopByStop) {
    const double at = exposure_for(spread(0.3f, 6)).value();
    for (const int stops : {-40, -3, 1, 20})
        EXPECT_NEAR(exposure_for(spread(std::ldexp(0.3f, stops), 6)).value(), at - stops, 1e-9);
    EXPECT_NEAR(10 * at, std::round(10 * at), 1e-9) << "in tenths";
}

TEST(AutoExposure, TinyLampsAndBlackBordersDoNotCount) {
    std::vector<float> values = spread(1, 5);
    const double at = exposure_for(values).value();
    for (size_t i = 0; i < 8; ++i) values.push_back(1e6f);
    values.push_back(infinity), values.push_back(NAN), values.push_back(-1);
    EXPECT_NEAR(exposure_for(values).value(), at, 0.11);
    values.resize(values.size() + 6000, 0.0f);
    EXPECT_NEAR(exposure_for(values).value(), at, 0.11);
    EXPECT_FALSE(exposure_for({0, 0, -1, NAN}));
    EXPECT_FALSE(exposure_for({}));
}

TEST(AutoExposure, DependsOnTheSceneAlone) {
    Bench bench;
    bench.scene.first_frame = 1, bench.scene.last_frame = 24;
    const double exposure = bench.exposure();
    bench.request.frames = {7, 9}, bench.request.mode = "froxel", bench.request.seed = 5;
    bench.request.settings = settings_for(Quality::reference);
    bench.request.resolution = {80, 60};
    bench.request.crop_low = {3, 3}, bench.request.crop_high = {9, 9};
    EXPECT_EQ(bench.exposure(), exposure);
    const Snapshot seventh = make_snapshot(bench.scene, moment_of(bench.scene, 7));
    EXPECT_EQ(automatic_exposure(bench.scene, bench.request, 1, &seventh), exposure);
    for (Material& material : bench.scene.materials) material.emission *= 64.0f;
    EXPECT_LT(bench.exposure(), exposure - 3);
}

TEST(AutoExposure, OfAFilmThatFadesInFromBlackIsThatOfItsEnd) {
    Bench bench;
    bench.scene.nodes.clear(), bench.scene.meshes.clear(), bench.scene.instances.clear();
    bench.scene.lights.clear(), bench.scene.media.clear();
    Keyed<vec3>& back = bench.scene.background.color;
    const auto over = [&](vec3 first, vec3 last) {
        back.times = {0, 1}, back.values = {first, last};
        bench.scene.first_frame = 0, bench.scene.last_frame = 24;
        return bench.exposure();
    };
    const double bright = over(vec3(4), vec3(4));
    EXPECT_NEAR(over(vec3(0), vec3(4)), bright, 1e-9);
    EXPECT_NEAR(over(vec3(4), vec3(0)), bright, 1e-9);
    EXPECT_NEAR(over(vec3(1), vec3(1)), bright + 2, 1e-9);
    EXPECT_EQ(over(vec3(0), vec3(0)), 0);
}

TEST(AutoExposure, CountsLightOfAllOrders) {
    Bench bench;
    bench.scene.media[0].albedo = Keyed<vec3>(vec3(0.99f)), bench.scene.media[0].extinction = Keyed<float>(2);
    bench.scene.media[0].bounds = {vec3(-1, -1, -4), vec3(1, 1, -1)};
    EXPECT_LT(bench.exposure(all_orders), bench.exposure(1) - 0.2);
    EXPECT_EQ(orders_of(find_mode("march"), bench.request.settings), 1);
    EXPECT_EQ(orders_of(find_mode("path"), bench.request.settings), all_orders);
    EXPECT_EQ(orders_of(find_mode("cone"), bench.request.settings), 1);
}

TEST(AutoExposure, IsMeasuredWhereNothingIsStated) {
    Bench bench;
    RenderPlan plan;
    plan.exposure = 3.5;
    EXPECT_TRUE(needs_auto_exposure(bench.scene, bench.request));
    EXPECT_EQ(display_of(bench.scene, bench.request, plan, 1).exposure, 3.5);
    bench.scene.exposure = Keyed<float>(-2), bench.scene.own_exposure = true;
    EXPECT_FALSE(needs_auto_exposure(bench.scene, bench.request));
    EXPECT_EQ(display_of(bench.scene, bench.request, plan, 1).exposure, -2);
    bench.request.exposure = 1;
    EXPECT_EQ(display_of(bench.scene, bench.request, plan, 1).exposure, 1);
    bench.request.exposure.reset(), bench.request.automatic_exposure = true;
    EXPECT_EQ(display_of(bench.scene, bench.request, plan, 1).exposure, 3.5);
}

TEST(AutoExposure, IsTheSameInEveryPartOfASequence) {
    const TempFolder in, all, single;
    Scene scene = moving_scene(in);
    scene.first_frame = 1, scene.last_frame = 3;
    RenderRequest job = job_for(scene, all.file("f.####.exr"), {1, 2, 3});
    job.png = true;
    const RenderReport report = run(scene, job);
    job.output = single.file("f.####.exr"), job.frames = {3};
    run(scene, job);
    EXPECT_EQ(all.contents()["f.0003.png"], single.contents()["f.0003.png"]);
    for (const FrameReport& frame : report.frames) EXPECT_EQ(frame.exposure, report.frames[0].exposure);
    job.resume = true, std::filesystem::remove(single.path() / "f.0003.png");
    EXPECT_TRUE(run(scene, job).frames[0].kept);
    EXPECT_EQ(all.contents()["f.0003.png"], single.contents()["f.0003.png"]);
}
}

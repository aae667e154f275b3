// Errors promised before they are known, and times kept by a clock of the test's own.
#include "base/random.h"
#include "integrate/ray_batch.h"
#include "modes/mode.h"
#include "render/adaptive/check.h"
#include "render/adaptive/to_target.h"
#include "render/frame/noise_fixtures.h"
#include "scene/camera.h"
#include "scene/file/scene_file.h"
#include "scene/light.h"
#include "support/threads.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// A moment of an example scene at a small size, and its exact picture as two independent halves.
struct Example {
    Scene scene;
    Snapshot snapshot;
    View view;
    Settings settings = settings_for(Quality::preview);

    explicit Example(const std::string& name)
        : scene(load_scene(std::filesystem::path(TYNDALL_SOURCE_DIR) / "scenes" / (name + ".json"))) {
        const Moment moment = moment_of(scene, scene.first_frame);
        snapshot = make_snapshot(scene, moment, nullptr, MissingFrame::error);
        view.camera = camera_at(scene, find_camera(scene, ""), moment.seconds);
        view.size = {64, 36}, view.pixel_samples = 4;
    }
};

struct Halves {
    Image<vec3> color_a, color_b, fog_a, fog_b;
};

Layers exact_picture(const Example& example, uint32_t seed, int samples) {
    View view = example.view;
    view.pixel_samples = samples, view.seed = seed;
    FrameStats stats;
    return render_frame(find_mode("march"), view, example.snapshot, truth_settings(example.settings), {}, stats);
}

Halves exact_halves(const Example& example, int samples) {
    const Layers a = exact_picture(example, 77, samples), b = exact_picture(example, 78, samples);
    return {a.color, b.color, a.inscatter, b.inscatter};
}

// rmse over mean; the noise of the halves falls out of the product of their differences.
double relative_rmse(const Image<vec3>& image, const Image<vec3>& a, const Image<vec3>& b) {
    double product = 0, mean = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const dvec3 own(image.pixels[i]), one(a.pixels[i]), other(b.pixels[i]);
        product += glm::dot(own - one, own - other) / 3;
        mean += (one.x + one.y + one.z + other.x + other.y + other.z) / 6;
    }
    const double count = static_cast<double>(image.pixels.size());
    return std::sqrt(std::max(product / count, 0.0)) / (mean / count);
}

double true_error(const Layers& layers, const Halves& truth) {
    return std::max(relative_rmse(layers.color, truth.color_a, truth.color_b),
                    relative_rmse(layers.inscatter, truth.fog_a, truth.fog_b));
}

struct Result {
    Layers layers;
    FrameStats stats;
};

Result to_goal(const Example& example, const Goal& goal, const FrameOptions& options = {}) {
    Result result;
    result.layers = render_to_target(find_mode("march"), example.view, example.snapshot, example.settings, goal,
                                     options, result.stats);
    return result;
}

void keeps_its_promise(const std::string& name, int truth_samples, PixelFilter filter) {
    Example example(name);
    example.view.filter = filter;
    const Halves truth = exact_halves(example, truth_samples);
    for (const double target : {0.1, 0.03}) {
        const Result result = to_goal(example, {target, 0, Quality::preview, {}});
        EXPECT_LE(result.stats.error()->bound, target);
        EXPECT_LT(result.stats.integrator->error.bound, target);
        EXPECT_LE(true_error(result.layers, truth), target) << name << " " << result.stats.integrator->candidate;
    }
}
}

// At the centers of pixels: elsewhere in them bright edges and lamps make short references noisier than the targets.
TEST(Goal, MarchKeepsItsPromiseAtTheCentersOfPixels) {
    keeps_its_promise("window", 4, PixelFilter::center);
    keeps_its_promise("spotlight", 2, PixelFilter::center);
}
TEST(Goal, NightlyMarchKeepsItsPromiseInTheWindow) { keeps_its_promise("window", 256, PixelFilter::blackman_harris); }
TEST(Goal, NightlyMarchKeepsItsPromiseBetweenThePillars) {
    keeps_its_promise("pillars", 64, PixelFilter::blackman_harris);
}

TEST(Goal, CandidatesGetFinerAndTheTruthIsTheLast) {
    const Settings settings = settings_for(Quality::preview);
    const std::vector<Candidate> all = candidates_of(find_mode("march"), settings, Quality::preview);
    ASSERT_GE(all.size(), 4u);
    int compared = 0;
    for (size_t i = 1; i < all.size(); ++i) {
        const MarchSettings &coarse = all[i - 1].settings.march, &fine = all[i].settings.march;
        if (fine.visibility == Visibility::exact) continue;
        ++compared;
        EXPECT_LE(fine.step_voxels, coarse.step_voxels) << all[i].name;
        EXPECT_LE(fine.step_depth, coarse.step_depth) << all[i].name;
        EXPECT_LE(fine.step_share, coarse.step_share) << all[i].name;
        EXPECT_GE(all[i].settings.terms.light_resolution, all[i - 1].settings.terms.light_resolution) << all[i].name;
        EXPECT_GE(fine.nodes, coarse.nodes) << all[i].name;
    }
    EXPECT_GE(compared, 3);
    for (const SettingRow& row : setting_rows())
        EXPECT_EQ(row.get(all.back().settings), row.get(truth_settings(settings))) << row.name;
}

// Steps are what candidates cost on the same rays, but for the last, whose are of another kind.
TEST(Goal, CandidatesCostMoreAndMore) {
    const Example example("spotlight");
    View view = example.view;
    view.size = {16, 9}, view.pixel_samples = 1;
    uint64_t before = 0;
    std::vector<Candidate> all = candidates_of(find_mode("march"), settings_for(Quality::preview), Quality::preview);
    all.pop_back();
    for (Candidate& candidate : all) {
        apply_setting(candidate.settings, "terms.light_resolution=16"); // for speed: steps do not depend on it
        FrameStats stats;
        render_frame(find_mode("march"), view, example.snapshot, candidate.settings, {}, stats);
        EXPECT_GE(stats.steps, before) << candidate.name;
        EXPECT_GT(stats.steps, 0u) << candidate.name;
        if (candidate.name == "marched") {
            EXPECT_GT(stats.steps, 3 * before) << "fog is followed to the light";
        }
        before = stats.steps;
    }
}

TEST(Goal, RowsThatAreSetStay) {
    Settings settings = settings_for(Quality::preview);
    apply_setting(settings, "terms.light_resolution=20");
    apply_setting(settings, "terms.ambient=off");
    for (const Candidate& candidate : candidates_of(find_mode("march"), settings, Quality::preview)) {
        EXPECT_EQ(candidate.settings.terms.light_resolution, 20);
        EXPECT_FALSE(candidate.settings.terms.ambient);
    }
    EXPECT_EQ(truth_settings(settings).terms.light, LightTransmittance::marched);
    EXPECT_FALSE(truth_settings(settings).terms.ambient);
}

TEST(Goal, ACoarseRowThatIsSetIsMeasuredAndMissesTheTarget) {
    Example example("window");
    apply_setting(example.settings, "march.visibility=off");
    const Result result = to_goal(example, {0.05, 0, Quality::preview, {}});
    EXPECT_GT(result.stats.integrator->error.error, 0.05);
    EXPECT_GT(result.stats.error()->bound, 0.05);
    EXPECT_LT(result.stats.samples, 1000) << "noise far below an error that stays is of no use";
    const Halves truth = exact_halves(example, 2);
    EXPECT_NEAR(true_error(result.layers, truth) / result.stats.error()->error, 1, 0.1);
}

// Tiles and samples that a candidate was chosen by flatter it.
TEST(Goal, ChecksAreIndependentOfEachOtherAndOfTheChoice) {
    const Example example("window");
    const Mode& march = main_mode();
    const Goal goal{1, 0, Quality::preview, steady_seconds};
    const Choice choice = choose(march, example.view, example.snapshot, example.settings, goal, 0, {});
    ASSERT_GT(choice.measured.integrator.value, 0);
    std::vector<double> bounds{choice.measured.integrator.bound};
    for (const uint32_t salt : {1u, 2u}) {
        const Choice after = check_choice(choice, {choice.scout->layers, {}, 4, 4}, infinity, march, example.view,
                                          example.snapshot, example.settings, goal, salt, {});
        EXPECT_EQ(after.candidate.name, choice.candidate.name);
        EXPECT_EQ(std::ranges::count(bounds, after.measured.integrator.bound), 0) << salt;
        bounds.push_back(after.measured.integrator.bound);
    }
}

TEST(Goal, AFinerCandidateIsNamedOnlyWhereOneMayBegin) {
    const Example example("window");
    Goal goal{1, 0, Quality::preview, steady_seconds};
    const Choice choice = choose(main_mode(), example.view, example.snapshot, example.settings, goal, 0, {});
    ASSERT_GT(choice.measured.integrator.value, 0);
    goal.error = 0.1 * std::sqrt(choice.measured.integrator.value);
    const auto after = [&](bool may_restart) {
        return check_choice(choice, {choice.scout->layers, {}, 4, 4, may_restart}, infinity, main_mode(), example.view,
                            example.snapshot, example.settings, goal, 1, {});
    };
    EXPECT_NE(after(true).candidate.name, choice.candidate.name);
    const Choice kept = after(false);
    EXPECT_EQ(kept.candidate.name, choice.candidate.name);
    EXPECT_GT(kept.measured.integrator.bound, goal.error * goal.error) << "and its own error is told";
}

// Nor is more seen of a doubtful error than another mode would cost.
TEST(Goal, WhatSeemsToMissTheTargetIsLookedAtNoLongerThanAnotherModeTakes) {
    const Example example("window");
    Goal goal{1, 0, Quality::preview, steady_seconds};
    const Choice choice = choose(main_mode(), example.view, example.snapshot, example.settings, goal, 0, {});
    const auto integrator = [&] {
        return check_choice(choice, {choice.scout->layers, {}, 4, 4}, infinity, main_mode(), example.view,
                            example.snapshot, example.settings, goal, 1, {})
            .measured.integrator;
    };
    goal.error = std::sqrt(choice.measured.integrator.value), goal.other_work = 0;
    const SquaredError first = integrator();
    goal.error = std::sqrt(first.value); // less than the bound: whether it is met shows on more tiles only
    EXPECT_EQ(integrator().bound, first.bound);
    goal.other_work = infinity;
    EXPECT_NE(integrator().bound, first.bound);
}

TEST(Goal, PicturesOfATargetHaveTheSameBitsForAnyThreadCount) {
    const Example example("window");
    const auto made = [&] { return to_goal(example, {0.1, 0, Quality::preview, {}}); };
    const Result one = on_threads(1, made), two = on_threads(2, made);
    EXPECT_TRUE(same_bits(one.layers.color, two.layers.color));
    EXPECT_EQ(one.stats.error()->bound, two.stats.error()->bound);
    EXPECT_EQ(one.stats.integrator->candidate, two.stats.integrator->candidate);
}

namespace {
// A microsecond for each ray, unless a test sets more; a thousand to prepare.
std::atomic<int64_t> microseconds = 0, ray_microseconds = 1;
double counted_seconds() { return 1e-6 * static_cast<double>(microseconds); }

ScatterFunction prepare_counted(const View&, const Snapshot&, const Settings&, History*) {
    microseconds += 1000;
    return [](const RayBatch& batch, std::span<Scatter> results) {
        microseconds += ray_microseconds * static_cast<int64_t>(batch.rays.size());
        for (size_t i = 0; i < results.size(); ++i) results[i] = {vec3(to_unit(batch.ids[i])), 1, 1, 1};
    };
}

FrameStats counted(double error, double seconds, const FrameOptions& options = {}) {
    static const Scene scene;
    FrameStats stats;
    const Goal goal{error, seconds, Quality::preview, counted_seconds};
    render_to_target(own_mode(prepare_counted), plain_view({16, 16}, 4), snapshot_of(scene), {}, goal, options, stats);
    return stats;
}
constexpr double sample_seconds = 256e-6;
}

TEST(Goal, TimeIsKept) {
    for (const double seconds : {0.005, 0.02, 0.1, 0.5}) {
        const FrameStats stats = counted(0, seconds);
        EXPECT_LE(stats.goal_seconds, seconds);
        EXPECT_GE(stats.goal_seconds, std::min(0.8 * seconds, seconds - 2 * sample_seconds)) << stats.samples;
        const double error = std::sqrt(random_variance / stats.samples) / random_mean;
        EXPECT_NEAR(stats.noise->error / error, 1, 0.3) << stats.samples;
    }
}

TEST(Goal, OneSampleIsTheLeast) {
    const FrameStats stats = counted(0, 1e-6);
    EXPECT_EQ(stats.samples, 1);
    const double error = std::sqrt(random_variance) / random_mean;
    EXPECT_NEAR(stats.noise->error / error, 1, 0.15);
    EXPECT_GT(stats.noise->bound, stats.noise->error);
}

TEST(Goal, AFirstSampleThatIsQuickerThanExpectedIsFollowedByMore) {
    static const Scene scene;
    Choice slow;
    slow.measured.sample_seconds = 1; // expected
    Goal goal{0, 0.02, Quality::preview, counted_seconds};
    goal.choice = std::make_shared<const Choice>(slow);
    FrameStats stats;
    render_to_target(own_mode(prepare_counted), plain_view({16, 16}, 4), snapshot_of(scene), {}, goal, {}, stats);
    EXPECT_GT(stats.samples, 50);
    EXPECT_LE(stats.goal_seconds, 0.02);
}

TEST(Goal, WhatComesFirstEndsIt) {
    const FrameStats reached = counted(0.05, 10);
    EXPECT_LE(reached.noise->bound, 0.05);
    EXPECT_LT(reached.goal_seconds, 1);
    const FrameStats stopped = counted(0.005, 0.05);
    EXPECT_GT(stopped.noise->bound, 0.005);
    EXPECT_LE(stopped.goal_seconds, 0.05);
}

TEST(Goal, NoiseAloneIsForecastAfterTheFirstRound) {
    std::vector<double> forecasts;
    FrameOptions options;
    options.forecast = [&](double seconds) { forecasts.push_back(seconds); };
    const FrameStats stats = counted(0.01, 0, options); // 3333 samples and more
    EXPECT_LE(stats.noise->bound, 0.01);
    ASSERT_EQ(forecasts.size(), 1u);
    EXPECT_NEAR(stats.goal_seconds / forecasts[0], 1, 0.3);
    EXPECT_NEAR(stats.goal_seconds / stats.forecast_seconds, 1, 0.3);
}

TEST(Goal, WhatIsFarIsStoppedAfterTenMinutes) {
    ray_microseconds = 1000;
    const FrameStats stats = counted(0.01, 0);
    ray_microseconds = 1;
    EXPECT_GT(stats.forecast_seconds, 700);
    EXPECT_GT(stats.noise->bound, 0.01);
    EXPECT_LE(stats.goal_seconds, 600);
    EXPECT_GT(stats.goal_seconds, 400);
}

// What was chosen beforehand sees no shadows, which makes the goal seem out of reach.
TEST(Goal, AFinerCandidateIsTakenWhereTheOneChosenIsFarFromTheError) {
    const Example example("window");
    Goal goal{0.2, 0, Quality::preview, steady_seconds};
    Choice coarse = choose(main_mode(), example.view, example.snapshot, example.settings, goal, 0, {});
    apply_setting(coarse.candidate.settings, "march.visibility=off");
    coarse.scout = nullptr, coarse.measured.prepared = nullptr;
    coarse.measured.integrator.value = coarse.measured.integrator.bound = 1;
    goal.choice = std::make_shared<Choice>(coarse);
    std::vector<double> forecasts;
    FrameOptions options;
    options.forecast = [&](double seconds) { forecasts.push_back(seconds); };
    const Result result = to_goal(example, goal, options);
    ASSERT_GT(forecasts.size(), 1u) << "what is wrong early on is told anew";
    EXPECT_EQ(forecasts[0], infinity);
    EXPECT_LT(result.stats.forecast_seconds, infinity);
    EXPECT_NE(result.stats.integrator->candidate, coarse.candidate.name);
    EXPECT_LE(result.stats.error()->bound, goal.error);
}

// A clock that ticks whenever it is looked at: there is no time for more than one sample.
TEST(Goal, MarchTakesOneSampleOfACandidateWhateverTheTime) {
    const Example example("window");
    double now = 0;
    const Result result = to_goal(example, {0, 1e-3, Quality::preview, [&now] { return now += 0.5; }});
    ASSERT_TRUE(result.stats.integrator);
    EXPECT_FALSE(result.stats.integrator->candidate.empty());
    EXPECT_EQ(result.stats.samples, 1);
    const double error = true_error(result.layers, exact_halves(example, 4));
    EXPECT_NEAR(error / result.stats.error()->error, 1, 0.35);
}

TEST(Goal, MarchStopsAtTheErrorWhereThereIsTimeLeft) {
    const Example example("window");
    double now = 0;
    const Result timed = to_goal(example, {0.2, 1e6, Quality::preview, [&now] { return now += 0.5; }});
    EXPECT_LE(timed.stats.error()->bound, 0.2);
    EXPECT_LT(timed.stats.goal_seconds, 1000);
    EXPECT_LT(timed.stats.samples, 1000);
}
}

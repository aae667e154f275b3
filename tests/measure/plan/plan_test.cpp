// Plans of scenes of which it is known what they need.
#include "measure/plan/plan.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include "measure/metrics/halves.h"
#include "render/adaptive/to_target.h"
#include "scene/file/scene_file.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box room{vec3(-4), vec3(4)};

View small_view() {
    View view;
    view.camera = look_at({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 0.9f);
    view.size = {64, 36}, view.pixel_samples = 1;
    return view;
}

const Term& term_named(const std::vector<Term>& terms, std::string_view name) {
    for (const Term& term : terms)
        if (term.name == name) return term;
    ADD_FAILURE() << "no term " << name;
    return terms.front();
}

Plan plan_of(const Snapshot& snapshot, double error) {
    return make_plan(modes(), small_view(), snapshot, Settings{}, {error, 0, Quality::preview, {}, {}});
}

TEST(Terms, WhatIsNotThereIsLeftOutForCertain) {
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(0.1f, room)}, {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)});
    const std::vector<Term> terms = terms_of(small_view(), snapshot, Settings{}, 0.01);
    for (const char* name : {"shadows", "varying density", "phase function", "emission", "ambient light in fog"}) {
        const Term& term = term_named(terms, name);
        EXPECT_TRUE(term.rigorous) << name;
        EXPECT_FALSE(term.needed) << name;
        EXPECT_EQ(term.bound, 0) << name;
    }
}

// 8 m across each side: no line is longer than 13.9 m.
TEST(Terms, ThinFogNeedsNoDimmingForCertain) {
    const float extinction = 1e-4f;
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(extinction, room)}, {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)});
    EXPECT_NEAR(max_optical_depth(snapshot), extinction * 8 * std::sqrt(3.0), 1e-8);
    const std::vector<Term> terms = terms_of(small_view(), snapshot, Settings{}, 0.05);
    for (const char* name : {"light-side transmittance", "fog in front of surfaces"}) {
        const Term& term = term_named(terms, name);
        EXPECT_TRUE(term.rigorous) << name;
        EXPECT_FALSE(term.needed) << name;
        EXPECT_GE(term.bound, std::expm1(max_optical_depth(snapshot))) << name;
    }
    EXPECT_EQ(drop_unneeded(terms, Settings{}).terms.light, LightTransmittance::off);
}

TEST(Terms, ShadowsCountAtEveryMomentOfAnOpenShutter) {
    TestScene stage = make_scene({homogeneous_medium(0.1f, room)}, {spot_light({0, 3, 0}, {0, -1, 0}, 50, 0.4f, 0.5f)},
                                 {box_of({-0.5f, 1, -0.5f}, {0.5f, 1.2f, 0.5f})});
    View view = small_view();
    const double still = term_named(terms_of(view, stage.snapshot, Settings{}, 0.05), "shadows").error;
    EXPECT_GT(still, 0.1);
    auto shutter = std::make_shared<OpenShutter>();
    shutter->cameras = {view.camera, view.camera}, view.shutter = shutter;
    const std::vector<Snapshot> moments{stage.snapshot, stage.snapshot};
    stage.snapshot.moments = std::make_shared<const std::vector<Snapshot>>(moments);
    const Term term = term_named(terms_of(view, stage.snapshot, Settings{}, 0.05), "shadows");
    EXPECT_NEAR(term.error, still, 0.5 * still);
    EXPECT_TRUE(term.needed);
}

TEST(Terms, LightScatteredAgainIsNeededInThickFog) {
    Settings all;
    all.fluence.orders = all_orders;
    for (const float extinction : {1e-4f, 1.0f}) {
        const std::vector<Term> terms = terms_of(small_view(),
                                                 snapshot_of({homogeneous_medium(extinction, room)},
                                                             {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)}),
                                                 all, 0.05);
        const Term& term = term_named(terms, "multiple scattering");
        EXPECT_EQ(term.needed, extinction > 0.1f);
        EXPECT_EQ(drop_unneeded(terms, all).fluence.orders, extinction > 0.1f ? all_orders : 1);
    }
}

TEST(Terms, EndlessFogHasNoThickestLine) {
    EXPECT_EQ(max_optical_depth(snapshot_of({homogeneous_medium(0.1f)}, {})), infinity);
}

// Light in the middle of thick fog: what is lost on the way is the same measured and in closed form at every point of
// the picture's middle; here only that it is large, and known to be.
TEST(Terms, ThickFogForwardScatteringAndShadowsAreNeeded) {
    const Phase forward{PhaseKind::henyey_greenstein, 0.8f};
    const TestScene stage =
        make_scene({homogeneous_medium(0.5f, room, forward)}, {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)},
                   {quad({-2, -3, -3}, {0, 6, 0}, {0, 0, 3})});
    const std::vector<Term> terms = terms_of(small_view(), stage.snapshot, Settings{}, 0.02);
    for (const char* name : {"shadows", "light-side transmittance", "phase function"}) {
        const Term& term = term_named(terms, name);
        EXPECT_TRUE(term.needed) << name;
        EXPECT_GT(term.error, 0.1) << name;
        EXPECT_GE(term.bound, term.error) << name;
    }
    const Settings kept = drop_unneeded(terms, Settings{});
    EXPECT_EQ(kept.march.visibility, Visibility::intervals);
    EXPECT_TRUE(kept.terms.phase);
}

// Isotropic instead of g: the error of light seen under one angle is 1/(4 pi p) - 1; a sun in thin fog has one angle
// for each pixel, and an orthographic eye the same for all.
TEST(Terms, ErrorsAreThoseOfClosedForms) {
    View view = small_view();
    view.camera.ortho_height = 2, view.filter = PixelFilter::center;
    const Phase phase{PhaseKind::henyey_greenstein, 0.3f};
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.001f, Box{vec3(-10, -10, -1), vec3(10, 10, 1)}, phase)},
                                          {sun_light({1, 0, -1})});
    const std::vector<Term> terms = terms_of(view, snapshot, Settings{}, 1e-3);
    const double seen = phase_value_of<double>(phase, glm::dot(glm::normalize(vec3(1, 0, -1)), vec3(0, 0, 1)));
    const double expected = std::abs(1 / (4 * std::numbers::pi * seen) - 1);
    EXPECT_NEAR(term_named(terms, "phase function").error, expected, 2e-3 * expected);
}

TEST(Plan, NothingGetsThereByMoreSamplesThanThereMayBe) {
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(0.1f, room)}, {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)});
    const Plan plan = plan_of(snapshot, 1e-5);
    for (const Standing& standing : plan.standings)
        if (standing.best && standing.best->reaches_goal()) {
            EXPECT_LE(standing.best->samples, max_target_samples) << standing.mode->name;
        }
    const auto path = std::ranges::find(plan.standings, std::string_view("path"),
                                        [](const Standing& standing) { return standing.mode->name; });
    ASSERT_NE(path, plan.standings.end());
    ASSERT_TRUE(path->best);
    EXPECT_FALSE(path->best->reaches_goal());
}

TEST(Plan, ALoneSpotInEvenFogIsForTheConeOrAnotherClosedForm) {
    const Plan plan = plan_of(
        snapshot_of({homogeneous_medium(0.1f, room)}, {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)}), 0.02);
    EXPECT_TRUE(plan.chosen.reaches_goal());
    EXPECT_LE(plan.chosen.error, 0.02);
    const auto cone = std::ranges::find(plan.standings, "cone", [](const Standing& s) { return s.mode->name; });
    ASSERT_NE(cone, plan.standings.end());
    EXPECT_TRUE(cone->best->reaches_goal());
}

TEST(Plan, WhereShadowsFallTheConeStaysBehindAndLooksTakeNoPart) {
    const TestScene stage =
        make_scene({homogeneous_medium(0.2f, room)}, {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)},
                   {quad({-2, -3, -3}, {0, 6, 0}, {0, 0, 3})});
    const Plan plan = plan_of(stage.snapshot, 0.05);
    EXPECT_TRUE(plan.chosen.reaches_goal());
    for (const Standing& standing : plan.standings) {
        if (standing.mode->accuracy == Accuracy::artistic) {
            EXPECT_FALSE(standing.best) << standing.mode->name;
            EXPECT_FALSE(standing.why.empty());
        }
        if (standing.mode->name == "cone") {
            EXPECT_FALSE(standing.best->reaches_goal());
            EXPECT_GT(standing.best->error, 0.05);
        }
    }
    EXPECT_EQ(plan.standings.front().mode, plan.chosen.mode);
    EXPECT_NE(plan.certificate().find(std::string(plan.chosen.mode->name)), std::string::npos);
}

// At the centers of pixels the march has no noise, path tracing has; and it shadows ambient light.
TEST(Plan, PathTracingIsAsNoisyAsItIsAndTakesNoPartInAmbientLight) {
    TestScene stage =
        make_scene({homogeneous_medium(0.2f, room)}, {spot_light({-3, 2.5f, 0}, {3, -2, 0}, 50, 0.2f, 0.3f)},
                   {quad({-2, -3, -3}, {0, 6, 0}, {0, 0, 3})});
    View view = small_view();
    view.filter = PixelFilter::center;
    const auto path_of = [&] {
        const Plan plan = make_plan(modes(), view, stage.snapshot, Settings{}, {0.01, 0, Quality::preview, {}, {}});
        return *std::ranges::find(plan.standings, "path", [](const Standing& s) { return s.mode->name; });
    };
    const Standing noisy = path_of();
    ASSERT_TRUE(noisy.best);
    EXPECT_GT(noisy.best->samples, 50);
    stage.snapshot.ambient = vec3(0.1f);
    EXPECT_FALSE(path_of().best);
}

// A lamp in view: few pixels hold all of the noise, whose bound is far above what it is on the average.
TEST(Plan, SamplesAreThoseThatTheBoundTakes) {
    const TestScene stage = make_scene({homogeneous_medium(0.2f, room)}, {point_light({0.5f, 0.3f, 0}, 50)},
                                       {quad({-2, -3, -3}, {0, 6, 0}, {0, 0, 3})});
    const Goal goal{0.02, 0, Quality::preview, steady_seconds};
    const Contender march = sole_contender(main_mode(), small_view(), stage.snapshot, Settings{}, goal, {});
    FrameStats stats;
    render_to_target(main_mode(), small_view(), stage.snapshot, Settings{}, goal, {}, stats);
    EXPECT_LE(stats.error()->bound, goal.error);
    EXPECT_NEAR(march.samples / stats.samples, 1, 0.6) << stats.samples;
}

// Every plan of these scenes is kept: rendered as planned, the picture is as near to the truth as wanted. At the
// centers of pixels: elsewhere in them lamps and bright edges make pictures noisier than the targets for minutes.
class PlannedScene : public testing::TestWithParam<const char*> {};

View view_of_center(const Scene& scene, const Moment& moment) {
    View view;
    view.camera = camera_at(scene, find_camera(scene, ""), moment.seconds), view.size = {64, 36};
    view.filter = PixelFilter::center;
    return view;
}

// Two independent ones.
std::array<Layers, 2> truths(const View& view, const Snapshot& snapshot) {
    const bool soft = std::ranges::any_of(snapshot.lights, is_soft); // all that is random in the truth
    std::array<Layers, 2> halves;
    for (uint32_t half = 0; half < 2; ++half) {
        View of_half = view;
        of_half.pixel_samples = soft ? 8 : 1, of_half.seed = 71 + half;
        FrameStats unused;
        halves[half] = render_frame(find_mode("march"), of_half, snapshot, truth_settings(Settings{}), {}, unused);
    }
    return halves;
}

double error(const Image<vec3>& own, const Image<vec3>& first, const Image<vec3>& second) {
    double sum = 0;
    for (const Image<vec3>* half : {&first, &second})
        for (const vec3& pixel : half->pixels) sum += (pixel.x + pixel.y + pixel.z) / 3;
    const double mean = sum / (2 * static_cast<double>(own.pixels.size()));
    return std::sqrt(std::max(product_of_errors(own, own, first, second).value, 0.0)) / mean;
}

// As `render` does: by march where the plan's mode says that it misses the target.
void keeps_its_plan(const View& view, const Snapshot& snapshot, const std::array<Layers, 2>& halves, double wanted) {
    const Goal goal{wanted, 0, Quality::preview, {}, {}};
    const Plan plan = make_plan(modes(), view, snapshot, Settings{}, goal);
    FrameStats stats;
    Layers layers = render_to_target(*plan.chosen.mode, view, snapshot, plan.settings, goal, {}, stats);
    if (stats.error()->bound > wanted) {
        EXPECT_NE(plan.chosen.mode->name, main_mode().name);
        layers = render_to_target(main_mode(), view, snapshot, Settings{}, goal, {}, stats);
    }
    EXPECT_LE(stats.error()->bound, wanted);
    EXPECT_LE(error(layers.color, halves[0].color, halves[1].color), wanted) << plan_text(plan);
    EXPECT_LE(error(layers.inscatter, halves[0].inscatter, halves[1].inscatter), wanted) << plan_text(plan);
}

TEST_P(PlannedScene, NightlyIsAsRightAsWantedAtTheCentersOfPixels) {
    const Scene scene = load_scene(std::filesystem::path(TYNDALL_SOURCE_DIR) / GetParam());
    const Moment moment = moment_of(scene, scene.first_frame);
    const Snapshot snapshot = make_snapshot(scene, moment, nullptr, MissingFrame::error);
    const View view = view_of_center(scene, moment);
    const std::array<Layers, 2> halves = truths(view, snapshot);
    for (const double wanted : {0.05, 0.02}) keeps_its_plan(view, snapshot, halves, wanted);
}
INSTANTIATE_TEST_SUITE_P(Plan, PlannedScene,
                         testing::Values("scenes/window.json", "scenes/spotlight.json", "scenes/pillars.json",
                                         "scenes/lantern.json", "scenes/cloud.json",
                                         "tests/measure/plan/plan_scenes/even_room.json",
                                         "tests/measure/plan/plan_scenes/bare_spot.json",
                                         "tests/measure/plan/plan_scenes/foggy_colonnade.json",
                                         "tests/measure/plan/plan_scenes/three_lamps.json",
                                         "tests/measure/plan/plan_scenes/glowing_cloud.json",
                                         "tests/measure/plan/plan_scenes/thin_haze.json"));
}
}

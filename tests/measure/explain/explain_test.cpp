// One ray's report against closed forms, against the reference, and against whole pictures.
#include "measure/explain/report.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include "render/adaptive/candidates.h"
#include "render/frame/frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
using testing::HasSubstr;
using testing::Not;

constexpr ivec2 middle(16, 8); // the pixel that looks along -z

View axis_view() {
    View view;
    view.camera.position = vec3(0), view.size = {33, 17};
    return view;
}

Mesh named(Mesh mesh, const char* name) {
    mesh.name = name;
    return mesh;
}

// Lies above the ray at height 1, from z = -3 to -5.
Mesh plate() { return named(quad({-1, 1, -5}, {2, 0, 0}, {0, 0, 2}), "plate"); }
// Ends the ray at 10 m.
Mesh wall() { return named(quad({-50, -50, -10}, {100, 0, 0}, {0, 100, 0}), "wall"); }

Medium hall() { return homogeneous_medium(0.2f, {{-20, -20, -20}, {20, 20, 20}}); }

RayReport told(const Snapshot& snapshot, std::vector<const Mode*> asked = {}, const View& view = axis_view(),
               ivec2 pixel = middle) {
    ExplainOptions options;
    options.modes = std::move(asked), options.noisy_samples = 4096;
    return explain_ray(view, snapshot, settings_for(Quality::preview), pixel, options);
}

vec3 sum_of(const RayReport& report) {
    dvec3 sum(0);
    for (size_t i = 0; i < report.steps.size(); ++i) sum += dvec3(added_by(report, i));
    return vec3(sum);
}

void expect_near(vec3 a, vec3 b, double share) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], share * std::abs(double(b[c]))) << "channel " << c;
}

TEST(Explain, FogIsThatOfBeerAndLambert) {
    const float sigma = 0.3f;
    const RayReport report = told(snapshot_of({homogeneous_medium(sigma, {{-1, -1, -8}, {1, 1, -2}})}, {}));
    ASSERT_FALSE(report.steps.empty());
    EXPECT_NEAR(report.steps.front().low, 2, 1e-6);
    EXPECT_NEAR(report.steps.back().high, 8, 1e-6);
    EXPECT_NEAR(report.depth, 1.8, 1e-6);
    EXPECT_NEAR(report.reference.transmittance, std::exp(-1.8), 1e-6);
    double at = 2, seen = 0;
    for (const RayStep& step : report.steps) {
        EXPECT_EQ(step.low, at);
        EXPECT_NEAR(step.extinction, sigma, 1e-6);
        EXPECT_NEAR(step.to_eye, std::exp(-double(sigma) * (step.middle() - 2)), 1e-6);
        at = step.high, seen += step.reach;
    }
    EXPECT_NEAR(seen, (1 - std::exp(-1.8)) / 0.3, 1e-6);
    EXPECT_FALSE(report.hits);
    EXPECT_NEAR(report.end, 8, 1e-5);
}

TEST(Explain, AmbientLightHasItsClosedForm) {
    const RayReport report =
        told(snapshot_of({homogeneous_medium(0.3f, {{-1, -1, -8}, {1, 1, -2}})}, {}, vec3(0.5f, 1, 2)));
    expect_near(report.glow, vec3(0.5f, 1, 2) * static_cast<float>(1 - std::exp(-1.8)), 1e-5);
    expect_near(report.reference.inscatter, report.glow, 1e-5);
}

// Lit before and behind, dark in between: by a sun from above, and by a lamp at height 2 whose shadow is twice as long.
void expect_dark_between(const LightOnRay& light, double low, double high) {
    ASSERT_EQ(light.stretches.size(), 3u);
    EXPECT_EQ(light.stretches[0].state, LightState::full);
    EXPECT_EQ(light.stretches[1].state, LightState::shadowed);
    EXPECT_EQ(light.stretches[2].state, LightState::full);
    EXPECT_EQ(light.stretches[0].low, 0);
    EXPECT_NEAR(light.stretches[1].low, low, 1e-4);
    EXPECT_NEAR(light.stretches[1].high, high, 1e-4);
    EXPECT_NEAR(light.stretches[2].high, 10, 1e-4);
    EXPECT_EQ(light.stretches[1].blockers, std::vector<std::string>{"plate"});
    EXPECT_TRUE(light.stretches[0].blockers.empty());
}

TEST(Explain, AShadowLiesWhereItsPlateSays) {
    const TestScene stage = make_scene({hall()}, {sun_light({0, -1, 0}), point_light({0, 2, -4})}, {plate(), wall()});
    const RayReport report = told(stage.snapshot);
    ASSERT_EQ(report.lights.size(), 2u);
    expect_dark_between(report.lights[0], 3, 5);
    expect_dark_between(report.lights[1], 2, 6);
    ASSERT_EQ(report.surfaces.size(), 1u);
    EXPECT_EQ(report.surfaces[0].name, "wall");
    EXPECT_NEAR(report.surfaces[0].distance, 10, 1e-5);
    EXPECT_NEAR(report.surfaces[0].share, std::exp(-2.0), 1e-6);
    EXPECT_TRUE(report.hits);
}

TEST(Explain, ASpotReachesWhatItsConeHolds) {
    Light spot = point_light({0, 2, -4});
    spot.kind = LightKind::spot, spot.direction = {0, -1, 0}, spot.outer_cone = pi / 4;
    const RayReport report = told(snapshot_of({hall()}, {spot}));
    const std::vector<LightStretch>& stretches = report.lights[0].stretches;
    ASSERT_EQ(stretches.size(), 3u);
    EXPECT_EQ(stretches[0].state, LightState::out_of_reach);
    EXPECT_EQ(stretches[1].state, LightState::full);
    EXPECT_EQ(stretches[2].state, LightState::out_of_reach);
    EXPECT_NEAR(stretches[1].low, 2, 1e-4);
    EXPECT_NEAR(stretches[1].high, 6, 1e-4);
}

TEST(Explain, ASoftLightHasAHalfShadow) {
    // The shadow of an edge 1 m above, in a light of half angle a, is half dark over 2 tan a.
    Light light = sun_light({0, -1, 0});
    light.angle = 0.05f;
    const TestScene stage = make_scene({hall()}, {light}, {plate()});
    const RayReport report = told(stage.snapshot);
    const std::vector<LightStretch>& stretches = report.lights[0].stretches;
    ASSERT_EQ(stretches.size(), 5u);
    EXPECT_EQ(stretches[1].state, LightState::partial);
    EXPECT_EQ(stretches[2].state, LightState::shadowed);
    EXPECT_EQ(stretches[3].state, LightState::partial);
    const double half = std::tan(0.05);
    for (const size_t i : {size_t{1}, size_t{3}}) {
        const double edge = i == 1 ? 3 : 5;
        EXPECT_GE(stretches[i].low, edge - half - 1e-6);
        EXPECT_LE(stretches[i].high, edge + half + 1e-6);
        EXPECT_GT(stretches[i].high - stretches[i].low, 1.5 * half); // 64 points come near both rims
        EXPECT_NEAR(stretches[i].share, 0.5, 0.1);
    }
}

TEST(Explain, AlphaLetsItsShareThrough) {
    Mesh sheet = plate();
    sheet.material = 0; // alpha 1/2
    const TestScene stage = make_scene({hall()}, {sun_light({0, -1, 0})}, {sheet, wall()});
    const RayReport report = told(stage.snapshot);
    EXPECT_TRUE(report.lights[0].sampled);
    const std::vector<LightStretch>& stretches = report.lights[0].stretches;
    ASSERT_EQ(stretches.size(), 3u);
    EXPECT_EQ(stretches[1].state, LightState::partial);
    EXPECT_NEAR(stretches[1].share, 0.5, 1e-5);
    EXPECT_NEAR(stretches[1].low, 3, 10.0 / 128); // as the steps see it
    EXPECT_NEAR(stretches[1].high, 5, 10.0 / 128);
    EXPECT_EQ(stretches[1].blockers, std::vector<std::string>{"plate"});
}

TEST(Explain, TheRayGoesOnBehindASheet) {
    Mesh sheet = named(quad({-1, -1, -4}, {2, 0, 0}, {0, 2, 0}, 0), "sheet"); // alpha 1/2
    const TestScene stage = make_scene({hall()}, {sun_light({0, -1, 0})}, {sheet, wall()}, vec3(1));
    const RayReport report = told(stage.snapshot);
    ASSERT_EQ(report.surfaces.size(), 2u);
    EXPECT_EQ(report.surfaces[0].name, "sheet");
    EXPECT_EQ(report.surfaces[1].name, "wall");
    EXPECT_NEAR(report.surfaces[0].share, 0.5 * std::exp(-0.8), 1e-6);
    EXPECT_NEAR(report.surfaces[1].share, 0.5 * std::exp(-2.0), 1e-6);
    for (const RayStep& step : report.steps) {
        EXPECT_NEAR(step.to_eye, (step.low < 4 - 1e-6 ? 1 : 0.5) * std::exp(-0.2 * step.middle()), 1e-5);
        EXPECT_NEAR(step.depth, 0.2 * step.middle(), 1e-5);
    }
    EXPECT_NEAR(report.depth, 2, 1e-5);
    expect_near(sum_of(report), report.reference.inscatter, 1e-3);
}

// The middles of steps stand for them: off by (length)² / 24 times the curvature, less than a thousandth of the whole.
TEST(Explain, StepsAddUpToTheReference) {
    Light soft = point_light({0.5f, 2, -4}, 3);
    soft.radius = 0.1f, soft.name = "soft";
    Light near = point_light({0, 0.01f, -6}, 0.1f); // a centimeter off the ray
    near.intensity = {0.1f, 0.2f, 0.3f};
    const Medium grid = [] {
        Medium medium =
            medium_of(unit_volume(16, [](vec3 p) { return 0.5f + 0.5f * std::sin(9 * p.x + 7 * p.z); }), 0.5f);
        return medium;
    }();
    View view = axis_view();
    view.camera.position = {0.4f, 0.6f, 3};
    const TestScene stage =
        make_scene({hall(), grid}, {sun_light({0.3f, -1, 0.1f}), soft, near}, {plate(), wall()}, vec3(0.02f));
    for (const ivec2 pixel : {middle, ivec2(20, 10), ivec2(3, 2)}) {
        const RayReport report = told(stage.snapshot, {}, view, pixel);
        expect_near(sum_of(report), report.reference.inscatter, 1e-3);
        for (size_t l = 0; l < report.lights.size(); ++l) {
            dvec3 sum(0);
            for (size_t i = 0; i < report.steps.size(); ++i)
                sum += report.steps[i].reach * dvec3(report.lights[l].at[i].scattered);
            expect_near(vec3(sum), report.lights[l].fog, 2e-3);
        }
    }
}

TEST(Explain, StepsAddUpWithStyleToo) {
    const TestScene stage = make_scene({hall()}, {sun_light({0.3f, -1, 0.1f}), point_light({0.5f, 2, -4}, 3)},
                                       {plate(), wall()}, vec3(0.02f));
    Settings settings = settings_for(Quality::preview);
    settings.style = {0.4f, 0.6f, 1.5f, 9, vec3(1, 0.5f, 2)};
    const RayReport report = explain_ray(axis_view(), stage.snapshot, settings, middle, {});
    EXPECT_NEAR(report.depth, 10 * 0.2 * 1.5, 1e-5);
    expect_near(sum_of(report), report.reference.inscatter, 1e-3);
}

std::vector<const Mode*> all_modes() {
    std::vector<const Mode*> result;
    for (const Mode& mode : modes()) result.push_back(&mode);
    return result;
}

View one_sample(View view) {
    view.pixel_samples = view.lamp_samples = 1, view.filter = PixelFilter::center;
    return view;
}

TEST(Explain, ModesAnswerAsInTheirPictures) {
    Light lamp = point_light({0, 2, -6}, 8);
    lamp.name = "lamp";
    const TestScene stage = make_scene({hall()}, {sun_light({0.2f, -1, 0.1f}), lamp}, {plate(), wall()}, vec3(0.01f));
    const View view = one_sample(axis_view());
    const Settings settings = settings_for(Quality::preview);
    const ivec2 pixel(18, 7);
    const RayReport report = told(stage.snapshot, all_modes(), axis_view(), pixel);
    ASSERT_EQ(report.results.size(), modes().size());
    FrameStats stats;
    for (const ModeResult& result : report.results) {
        SCOPED_TRACE(result.mode);
        const Mode& mode = find_mode(result.mode);
        EXPECT_TRUE(result.finite);
        if (is_unbiased(mode)) continue;
        const Layers layers = render_frame(mode, view, stage.snapshot, settings, {}, stats);
        EXPECT_EQ(result.inscatter, layers.inscatter.at(pixel.x, pixel.y));
        EXPECT_EQ(result.color, layers.color.at(pixel.x, pixel.y));
        EXPECT_EQ(result.transmittance, layers.transmittance.at(pixel.x, pixel.y));
        EXPECT_EQ(result.validity, layers.validity.at(pixel.x, pixel.y));
        EXPECT_EQ(result.image_size.x > 0, mode.surfaces == Surfaces::post);
    }
    const Layers truth = render_frame(find_mode("march"), view, stage.snapshot, truth_settings(settings), {}, stats);
    expect_near(report.reference.inscatter, truth.inscatter.at(pixel.x, pixel.y), 1e-6);
    expect_near(report.reference.color, truth.color.at(pixel.x, pixel.y), 1e-6);
}

TEST(Explain, PathsOfOneScatteringAgreeWithTheReference) {
    const TestScene stage = make_scene({hall()}, {sun_light({0.2f, -1, 0.1f}, 3)}, {plate(), wall()});
    Settings settings = settings_for(Quality::preview);
    settings.path.orders = 1;
    ExplainOptions options;
    options.modes = {&find_mode("path")}, options.noisy_samples = 4096;
    const RayReport report = explain_ray(axis_view(), stage.snapshot, settings, middle, options);
    const ModeResult& path = report.results[0];
    ASSERT_TRUE(path.standard_error);
    EXPECT_EQ(path.samples, 4096);
    EXPECT_GT(path.standard_error->x, 0);
    EXPECT_LT(path.standard_error->x, 0.05 * report.reference.inscatter.x);
    EXPECT_NEAR(path.inscatter.x, report.reference.inscatter.x, 5 * path.standard_error->x);
}

TEST(Explain, LimitsOfLightsThatDoNotReachTheRayAreLeftOut) {
    Light away = point_light({0, 2, -4});
    away.name = "away", away.kind = LightKind::spot, away.direction = {0, 1, 0}, away.outer_cone = 0.3f;
    Light here = point_light({0, 2, -4});
    here.name = "here";
    const TestScene stage = make_scene({hall()}, {away, here}, {plate(), wall()});
    const RayReport report = told(stage.snapshot, {&find_mode("cone")});
    std::string said;
    for (const Limitation& one : report.results[0].limitations) said += where_of(one) + "\n";
    EXPECT_THAT(said, HasSubstr("light here"));
    EXPECT_THAT(said, Not(HasSubstr("light away")));
}

TEST(Explain, DifferencesAreOfLuminance) {
    ModeResult result, reference;
    reference.inscatter = vec3(2), result.inscatter = vec3(2.5f);
    EXPECT_NEAR(difference(result, reference), 0.25, 1e-6);
    EXPECT_EQ(difference_text(result, reference), "+25.0 %");
    result.inscatter = reference.inscatter = vec3(0);
    EXPECT_EQ(difference(result, reference), 0);
    result.inscatter = vec3(1);
    EXPECT_TRUE(std::isinf(difference(result, reference)));
}

TEST(Explain, ReportsStayWithinTheirColumns) {
    const TestScene stage = make_scene({hall()}, {sun_light({0.2f, -1, 0.1f})}, {plate(), wall()}, vec3(0.01f));
    const RayReport report = told(stage.snapshot, all_modes());
    const std::string text = explain_text(report, {"a scene.json", "eye", "preview", 1});
    for (size_t start = 0; start < text.size();) {
        const size_t end = text.find('\n', start);
        ASSERT_NE(end, text.npos);
        EXPECT_LE(end - start, 100u) << text.substr(start, end - start);
        start = end + 1;
    }
    EXPECT_THAT(text, HasSubstr("plate"));
    EXPECT_THAT(text, HasSubstr("froxel"));
    const std::string csv = explain_csv(report);
    EXPECT_EQ(static_cast<size_t>(std::ranges::count(csv, '\n')), report.steps.size() + 1);
}

TEST(Explain, NoFogIsAStoryToo) {
    const TestScene stage = make_scene({}, {sun_light({0.2f, -1, 0.1f})}, {wall()});
    const RayReport report = told(stage.snapshot, {&find_mode("march")});
    EXPECT_TRUE(report.steps.empty());
    EXPECT_EQ(report.reference.inscatter, vec3(0));
    EXPECT_EQ(report.results[0].inscatter, vec3(0));
    EXPECT_THAT(explain_text(report, {}), HasSubstr("no fog"));
    EXPECT_THAT(explain_svg(report, {}), HasSubstr("no fog"));
}
}
}

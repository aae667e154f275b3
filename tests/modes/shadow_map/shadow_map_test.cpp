// The march with shadow maps against closed forms, the reference and traced shadows.

#include "base/gauss_legendre.h"
#include "modes/map_shadows.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shadow_map/settings.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/threads.h"
#include "support/tiny_scenes.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/sparse_volume.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};

View tiny_view() {
    View view;
    view.camera = look_at({0.5f, 0.5f, 3}, {0.5f, 0.5f, 0}, {0, 1, 0}, 0.6f);
    view.size = {64, 64};
    return view;
}

std::vector<Scatter> run(std::string_view mode, const Snapshot& snapshot, const Settings& settings,
                         const std::vector<Ray>& rays) {
    return run_mode(mode, tiny_view(), snapshot, settings, rays);
}
Scatter run(const Snapshot& snapshot, const Settings& settings, const Ray& ray) {
    return run("shadow-map", snapshot, settings, std::vector{ray})[0];
}

// Rays of the view's picture to the end of the unit box.
std::vector<Ray> pixel_rays(int side = 16) {
    const View view = tiny_view();
    std::vector<Ray> rays;
    for (int i = 0; i < side * side; ++i) {
        Ray ray = camera_ray(view.camera, ivec2(side), vec2(i % side, i / side) + 0.5f);
        ray.t_max = 10;
        rays.push_back(ray);
    }
    return rays;
}

// The unit box of homogeneous fog, half of it in the shadow of a plate above.
struct HalfShadowed {
    Scene scene;
    Snapshot snapshot;

    explicit HalfShadowed(Light light, float extinction = 0.8f) {
        add_mesh(scene, quad({-2, 1.2f, -2}, {1.8f, 0, 0}, {1.5f, 0, 5}));
        snapshot = snapshot_of({homogeneous_medium(extinction, unit_box)}, {std::move(light)});
        snapshot.scene = &scene;
        snapshot.occluders = Occluders::make(scene, 0, nullptr);
        snapshot.bounds.grow(snapshot.occluders->bounds());
    }
};

Light lamp_above() {
    Light light = spot_light({0.6f, 2, 0.5f}, {0, -1, 0}, 5, 0.3f, 0.7f);
    return light;
}

TEST(ShadowMapMarch, SunInEvenFogMatchesClosedFormAtEveryDepth) {
    // Sun straight down, level ray at height y: L = w p E e^(-s(1-y)) (1 - e^(-s x)), for any number of steps.
    const float extinction = 1.5f, height = 0.3f;
    const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, unit_box)}, {sun_light({0, -1, 0}, 3)});
    for (const float depth : {0.01f, 0.1f, 0.37f, 0.8f, 1.0f, 2.0f}) {
        const double x = std::min(depth, 1.0f);
        const double expected = 3 / (4 * M_PI) * std::exp(-extinction * (1 - height)) * (1 - std::exp(-extinction * x));
        const Scatter result = run(snapshot, Settings{}, {{0.5f, height, 2}, {0, 0, -1}, 1 + depth});
        EXPECT_NEAR(result.radiance.x / expected, 1, 1e-4) << depth;
        EXPECT_NEAR(result.transmittance / std::exp(-extinction * x), 1, 1e-5) << depth;
    }
}

TEST(ShadowMapMarch, LocalLightsInEvenFogMatchQuadratureAtEveryDepth) {
    // Stated: within half a percent with the preview's steps, at every depth and from every side.
    Light point = point_light({0.3f, 0.7f, -2}, 5);
    Light ranged = point;
    ranged.range = 2.5f;
    Light spot = point;
    spot.kind = LightKind::spot, spot.direction = glm::normalize(vec3(-0.2f, -1, 0.1f));
    spot.inner_cone = 0.3f, spot.outer_cone = 0.6f;
    const float extinction = 0.6f;
    for (const Light& light : {point, ranged, spot})
        for (const Spacing spacing : {Spacing::angle, Spacing::distance})
            for (const float depth : {1.9f, 2.1f, 3.0f, 6.0f}) {
                Settings settings;
                settings.of<ShadowMapSettings>().spacing = spacing;
                const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction)}, {light});
                const Ray ray{{0, 0, 0}, {0, 0, -1}, depth};
                const auto integrand = [&](double t) {
                    const LightSample at = arrival(light, ray.at(static_cast<float>(t)));
                    return extinction / (4 * M_PI) * at.irradiance.x * std::exp(-extinction * (t + at.distance));
                };
                const double expected = integral(integrand, 0, depth);
                const float result = run(snapshot, settings, ray).radiance.x;
                EXPECT_NEAR(result / expected, 1, 0.005) << static_cast<int>(light.kind) << " " << depth;
            }
}

TEST(ShadowMapMarch, RayThroughALightIsFinite) {
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f)}, {point_light({0, 0, -2})});
    for (const float off : {0.0f, 1e-6f, 1e-3f}) {
        const Scatter result = run(snapshot, Settings{}, {{off, 0, 0}, {0, 0, -1}, 5});
        EXPECT_TRUE(is_finite(result.radiance)) << off;
        EXPECT_GT(result.radiance.x, 0) << off;
    }
}

TEST(ShadowMapMarch, FogThatEmitsAndAmbientLightAreTheirClosedForms) {
    Snapshot snapshot = snapshot_of({homogeneous_medium(2, unit_box)}, {}, vec3(0.5f, 1, 2));
    snapshot.media[0].optics.albedo = vec3(0.9f, 0.6f, 0.3f), snapshot.media[0].optics.emission.radiance = vec3(0.4f);
    const Scatter result = run(snapshot, Settings{}, {{0.5f, 0.5f, 3}, {0, 0, -1}, 10});
    const double covered = 1 - std::exp(-2.0);
    EXPECT_NEAR(result.radiance.x / ((0.5 * 0.9 + 0.2) * covered), 1, 1e-5);
    EXPECT_NEAR(result.radiance.z / ((2.0 * 0.3 + 0.2) * covered), 1, 1e-5);
}

TEST(ShadowMapMarch, HalfShadowedBoxConvergesToTheReference) {
    for (const Light& light : {sun_light({0.35f, -1, 0.2f}), lamp_above(), point_light({0.6f, 2, 0.5f}, 5)}) {
        const HalfShadowed box(light);
        const std::vector<Ray> rays = pixel_rays();
        Settings exact = exact_settings();
        const std::vector<Scatter> reference = run("march", box.snapshot, exact, rays);
        double error[3];
        for (int level = 0; level < 3; ++level) {
            Settings settings;
            settings.of<ShadowMapSettings>().steps = 8 << (2 * level),
            settings.of<ShadowMapSettings>().resolution = 128 << (2 * level);
            settings.terms.light = LightTransmittance::marched;
            error[level] = relative_rmse(run("shadow-map", box.snapshot, settings, rays), reference);
        }
        // Slope -1/2 or steeper of the error over the steps.
        EXPECT_LT(error[1], 0.5 * error[0]) << static_cast<int>(light.kind);
        EXPECT_LT(error[2], 0.25 * error[0]) << static_cast<int>(light.kind);
        EXPECT_LT(error[2], 0.01) << static_cast<int>(light.kind);
    }
}

TEST(ShadowMapMarch, MarchWithMapsIsMarchWithRays) {
    // The same steps: differences only where one lies within a texel of an edge. With texels of 5..10 mm and steps of
    // 40 mm that is one ray in six, off by one of 28 steps that near the lamp weighs up to twice its share: 3 %. All
    // kinds of light-side transmittance.
    const std::vector<Ray> rays = pixel_rays();
    for (const Light& light : {sun_light({0.35f, -1, 0.2f}), lamp_above(), point_light({0.6f, 2, 0.5f}, 5)})
        for (const LightTransmittance transmittance : {LightTransmittance::off, LightTransmittance::average,
                                                       LightTransmittance::grid, LightTransmittance::marched}) {
            const HalfShadowed box(light);
            Settings settings;
            settings.terms.light = transmittance, settings.of<ShadowMapSettings>().resolution = 512;
            settings.of<ShadowMapSettings>().pcf = 1;
            settings.march.visibility = Visibility::rays;
            const std::vector<Scatter> traced = run("march", box.snapshot, settings, rays);
            settings.march.visibility = Visibility::maps;
            EXPECT_LT(relative_rmse(run("march", box.snapshot, settings, rays), traced), 0.03)
                << static_cast<int>(light.kind);
        }
}

TEST(ShadowMapMarch, MapsComeCloserToRaysAsTexelsShrink) {
    // The number of rays that differ falls with the texel, so their root mean square by 4 from 64 to 1024 texels; less
    // is asked for, as it is few rays.
    const std::vector<Ray> rays = pixel_rays();
    for (const Light& light : {sun_light({0.35f, -1, 0.2f}), lamp_above(), point_light({0.6f, 2, 0.5f}, 5)}) {
        const HalfShadowed box(light);
        Settings settings;
        const std::vector<Scatter> traced = run("march", box.snapshot, settings, rays);
        settings.march.visibility = Visibility::maps;
        settings.of<ShadowMapSettings>().resolution = 64;
        const double coarse = relative_rmse(run("march", box.snapshot, settings, rays), traced);
        settings.of<ShadowMapSettings>().resolution = 1024;
        EXPECT_LT(relative_rmse(run("march", box.snapshot, settings, rays), traced), 0.6 * coarse)
            << static_cast<int>(light.kind);
    }
}

TEST(ShadowMapMarch, PartsOfLightsAddUp) {
    HalfShadowed box(sun_light({0.35f, -1, 0.2f}));
    box.snapshot.lights.push_back(lamp_above());
    const ScatterFunction scatter = find_mode("shadow-map").prepare(tiny_view(), box.snapshot, Settings{}, nullptr);
    const std::vector<Ray> rays = pixel_rays(4);
    const std::vector<uint32_t> ids(16, 7);
    std::vector<vec3> parts(16 * part_count(2), vec3(0));
    std::vector<Scatter> results(16);
    scatter({.rays = rays, .ids = ids, .parts = parts}, results);
    for (size_t i = 0; i < 16; ++i)
        EXPECT_NEAR(parts[part_count(2) * i].x + parts[part_count(2) * i + 1].x, results[i].radiance.x,
                    1e-6f * results[i].radiance.x);
}

TEST(ShadowMapMarch, TwoHalfDensityCopiesEqualOne) {
    const auto wavy = [](vec3 p) { return 0.5f + 0.5f * std::sin(9 * p.x) * std::cos(7 * p.y + 3 * p.z); };
    const SparseVolume volume = unit_volume(32, wavy);
    const Light light = point_light({0.5f, 1.4f, 0.5f});
    const Snapshot one = snapshot_of({medium_of(volume, 3)}, {light});
    const Snapshot two = snapshot_of({medium_of(volume, 1.5f), medium_of(volume, 1.5f)}, {light});
    const Ray ray{{0.4f, 0.45f, 3}, {0, 0, -1}, 10};
    const Scatter a = run(one, Settings{}, ray), b = run(two, Settings{}, ray);
    EXPECT_NEAR(a.radiance.x / b.radiance.x, 1, 1e-4);
    EXPECT_NEAR(a.transmittance / b.transmittance, 1, 1e-4);
}

TEST(ShadowMapMarch, StyleDimsTheFogsOwnLightOnly) {
    const Snapshot snapshot = snapshot_of({homogeneous_medium(1.5f, unit_box)}, {sun_light({0, -1, 0}, 3)});
    const Ray ray{{0.5f, 0.3f, 2}, {0, 0, -1}, 10};
    Settings settings;
    settings.style.view_depth = 0.25f, settings.style.light_depth = 0.5f;
    const Scatter plain = run(snapshot, Settings{}, ray), styled = run(snapshot, settings, ray);
    EXPECT_EQ(plain.transmittance, styled.transmittance);
    // L = p E e^(-½ s 0.7) (1 - e^(-¼ s)) / ¼
    const double expected = 3 / (4 * M_PI) * std::exp(-0.5 * 1.5 * 0.7) * (1 - std::exp(-0.25 * 1.5)) / 0.25;
    EXPECT_NEAR(styled.radiance.x / expected, 1, 1e-4);
    settings.style.range = 1;
    EXPECT_EQ(run(snapshot, settings, ray).radiance.x, 0) << "the fog begins beyond the range";
}

TEST(ShadowMapMarch, FogWithoutEndKeepsStepsInTheScene) {
    const HalfShadowed box(lamp_above());
    Snapshot endless = box.snapshot;
    endless.media = {homogeneous_medium(0.01f)};
    Ray ray{{0.5f, 0.5f, 3}, {0, 0, -1}, 2000};
    const float exact = run("march", endless, exact_settings(), {ray})[0].radiance.x;
    EXPECT_NEAR(run(endless, Settings{}, ray).radiance.x / exact, 1, 0.02);
}

TEST(ShadowMapMarch, LimitationsNameWhatMapsCannotDo) {
    HalfShadowed box(sun_light({0.35f, -1, 0.2f}));
    const auto said = [&](std::string_view mode, const Settings& settings) {
        return find_mode(mode).limitations(tiny_view(), box.snapshot, settings);
    };
    EXPECT_TRUE(has_limitation(said("shadow-map", Settings{}), limitation::coarse_texels));
    EXPECT_FALSE(has_limitation(said("shadow-map", Settings{}), limitation::hard_shadows));
    box.snapshot.lights[0].angle = 0.1f;
    EXPECT_TRUE(has_limitation(said("shadow-map", Settings{}), limitation::hard_shadows));
    Settings settings;
    EXPECT_FALSE(has_limitation(said("march", settings), limitation::hard_shadows));
    settings.march.visibility = Visibility::maps;
    EXPECT_TRUE(has_limitation(said("march", settings), limitation::hard_shadows));

    EXPECT_FALSE(has_limitation(said("shadow-map", Settings{}), limitation::long_steps));
    box.snapshot.media = {medium_of(unit_volume(64, [](vec3) { return 1.0f; }), 1)};
    settings.of<ShadowMapSettings>().steps = 2;
    EXPECT_TRUE(has_limitation(said("shadow-map", settings), limitation::long_steps));
    const Ray ray{{0.5f, 0.5f, 3}, {0, 0, -1}, 10};
    EXPECT_NEAR(run(box.snapshot, settings, ray).validity, 4.0f / 64 / 0.5f, 0.02f);
    settings.of<ShadowMapSettings>().steps = 64;
    EXPECT_EQ(run(box.snapshot, settings, ray).validity, 1);
}

TEST(ShadowMapMarch, LimitationsKnowHowFarTheFogReaches) {
    // A plume of two meters, beside the middle of the image, in haze of sixty: steps are those of the haze.
    Snapshot snapshot = snapshot_of(
        {homogeneous_medium(0.001f, {vec3(-30), vec3(30)}), homogeneous_medium(10, {vec3(-4, -1, -1), vec3(-2, 1, 1)})},
        {sun_light({0, -1, 0})});
    snapshot.bounds = snapshot.media[0].world_bounds;
    Settings settings;
    settings.of<ShadowMapSettings>().steps = 24;
    const Limitations told =
        find_mode("shadow-map").limitations(view_of({0, 0, 12}, vec3(0), {64, 36}), snapshot, settings);
    const auto deep = std::ranges::find_if(told, [](const Limitation& one) { return one.is(limitation::deep_steps); });
    ASSERT_NE(deep, told.end());
    EXPECT_EQ(deep->severity, Severity::wrong);
    EXPECT_GT(deep->amounts[1], 42.0 / 24);
    EXPECT_NEAR(deep->amounts[0], 10 * std::min(deep->amounts[1], 2.0), 3);
}

TEST(ShadowMapMarch, SameBitsOnAnyThreads) {
    const HalfShadowed box(lamp_above());
    const std::vector<Ray> rays = pixel_rays();
    const auto made = [&] { return run("shadow-map", box.snapshot, Settings{}, rays); };
    const std::vector<Scatter> one = on_threads(1, made), all = on_threads(3, made);
    for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(one[i].radiance, all[i].radiance);
}
}
}

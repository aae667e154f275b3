// The march against closed forms and quadrature of the light equation.

#include "base/gauss_legendre.h"
#include "base/random.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};

TEST(March, BeerLambertSlabIsExactForAnyStepCount) {
    for (const float extinction : {0.1f, 1.0f, 5.0f})
        for (const float share : {1.0f, 0.5f, 0.1f, 1.0f / 37, 1.0f / 512}) {
            Settings settings;
            settings.march.step_share = share, settings.march.step_depth = 10, settings.march.min_transmittance = 0;
            const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, unit_box)}, {});
            const Ray ray{{0.3f, 0.4f, 3}, {0, 0, -1}, 10};
            EXPECT_NEAR(marched(snapshot, settings, ray).transmittance / std::exp(-extinction), 1, 1e-5) << share;
        }
}

TEST(March, AmbientLightInEvenFogIsItsClosedForm) {
    // Constant source: L = ambient · albedo · (1 - T), for any number of steps.
    Snapshot snapshot = snapshot_of({homogeneous_medium(2, unit_box)}, {}, vec3(0.5f, 1, 2));
    snapshot.media[0].optics.albedo = vec3(0.9f, 0.6f, 0.3f);
    Settings settings;
    settings.march.min_transmittance = 0;
    const Scatter result = marched(snapshot, settings, {{0.5f, 0.5f, 3}, {0, 0, -1}, 10});
    const double covered = 1 - std::exp(-2.0);
    EXPECT_NEAR(result.radiance.x / (0.5 * 0.9 * covered), 1, 1e-5);
    EXPECT_NEAR(result.radiance.y / (1.0 * 0.6 * covered), 1, 1e-5);
    EXPECT_NEAR(result.radiance.z / (2.0 * 0.3 * covered), 1, 1e-5);
}

TEST(March, EmissionAbsorptionMatchesClosedForm) {
    // j = 1, sigma = 0.5, s = 3: (j/sigma)(1 - exp(-sigma s)) = 1.553739680.
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.5f, {vec3(-1.5f), vec3(1.5f)})}, {});
    snapshot.media[0].optics.albedo = vec3(0), snapshot.media[0].optics.emission.radiance = vec3(1);
    Settings settings;
    settings.march.min_transmittance = 0;
    EXPECT_NEAR(marched(snapshot, settings, {{0, 0, 5}, {0, 0, -1}, 20}).radiance.x, 1.553739680, 2e-5);
}

TEST(March, SunInEvenFogMatchesClosedForm) {
    // Sun straight down on the unit box, level view ray at height y: light path 1-y, so
    // L = w p E exp(-s(1-y)) (1 - exp(-s x)).
    const float extinction = 1.5f, height = 0.3f;
    const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, unit_box)}, {sun_light({0, -1, 0}, 3)});
    const Ray ray{{0.5f, height, 2}, {0, 0, -1}, 10};
    const double expected = 3 / (4 * M_PI) * std::exp(-extinction * (1 - height)) * (1 - std::exp(-extinction));
    for (const Quality quality : {Quality::preview, Quality::final, Quality::reference})
        EXPECT_NEAR(marched(snapshot, settings_for(quality), ray).radiance.x / expected, 1, 2e-4);
}

TEST(March, SlantedSunInEvenFogMatchesClosedForm) {
    // Light path grows along the ray: integrate the closed integrand (algorithm: Beer-Lambert both ways).
    const float extinction = 2;
    const vec3 direction = glm::normalize(vec3(-0.4f, -0.8f, 0.2f));
    const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, unit_box)}, {sun_light(direction)});
    const Ray ray{{0.2f, 0.3f, 2}, {0, 0, -1}, 10};
    const auto integrand = [&](double t) {
        const vec3 point = ray.at(static_cast<float>(t));
        const Interval<float> path = clip(unit_box, point, -direction, {0, infinity});
        return extinction / (4 * M_PI) * std::exp(-extinction * (t - 1 + path.high));
    };
    EXPECT_NEAR(marched(snapshot, sampled_settings(), ray).radiance.x / integral(integrand, 1, 2), 1, 1e-3);
}

// Airlight of an isotropic point light of 1 cd at distance h from the ray, camera a before the closest point.
struct Airlight {
    float extinction, h, a, expected;
};
class PointLightInEvenFog : public testing::TestWithParam<Airlight> {};

TEST_P(PointLightInEvenFog, MatchesTheAirlightIntegral) {
    const auto [extinction, h, a, expected] = GetParam();
    const Snapshot snapshot = snapshot_of({homogeneous_medium(extinction)}, {point_light({0, h, -a})});
    const float far = a + 60 / extinction;
    EXPECT_NEAR(marched(snapshot, sampled_settings(), {{0, 0, 0}, {0, 0, -1}, far}).radiance.x / expected, 1, 1e-3);
}
INSTANTIATE_TEST_SUITE_P(March, PointLightInEvenFog,
                         testing::Values(Airlight{1, 1, 1, 0.01745864f}, Airlight{0.1f, 1, 5, 0.01151431f},
                                         Airlight{0.5f, 0.1f, 2, 0.40195407f}, Airlight{2, 0.5f, 0.5f, 0.06983456f}));

TEST(March, PointLightWithAnisotropyAndSpotMatchQuadrature) {
    for (const float g : {0.0f, 0.5f, -0.4f}) {
        Light light = spot_light({0.3f, 0.7f, -2}, {-0.2f, -1, 0.1f}, 5, 0.3f, 0.6f);
        const float extinction = 0.6f;
        const Snapshot snapshot =
            snapshot_of({homogeneous_medium(extinction, everywhere(), {PhaseKind::henyey_greenstein, g})}, {light});
        const Ray ray{{0, 0, 0}, {0, 0, -1}, 6};
        const auto integrand = [&](double t) {
            const LightSample at = arrival(light, ray.at(static_cast<float>(t)));
            const double p = phase_value({PhaseKind::henyey_greenstein, g}, glm::dot(at.to_light, ray.direction));
            return extinction * p * at.irradiance.x * std::exp(-extinction * (t + at.distance));
        };
        EXPECT_NEAR(marched(snapshot, sampled_settings(), ray).radiance.x / integral(integrand, 0, 6), 1, 1e-3) << g;
    }
}

TEST(March, HeightFogTransmittanceMatchesClosedForm) {
    // s0 = 0.1, H = 10, upward cosine 0.5, length 40 from the base: tau = 1.729329434.
    Medium medium;
    medium.density.kind = DensityKind::height, medium.optics = {vec3(0.1f), vec3(1), {}, vec3(0)},
    medium.density.height_falloff = 10;
    Settings settings = sampled_settings();
    const Ray ray{{0, 0, 0}, {std::sqrt(0.75f), 0.5f, 0}, 40};
    EXPECT_NEAR(marched(snapshot_of({medium}, {}), settings, ray).transmittance / 0.177403331, 1, 1e-4);
}

TEST(March, ForwardScatteringIsBrighterTowardsTheSun) {
    // Ratio of looking into the sun and away from it: ((1+g)/(1-g))³.
    const float g = 0.6f;
    Settings settings = sampled_settings();
    settings.terms.light = LightTransmittance::off;
    const Snapshot snapshot = snapshot_of(
        {homogeneous_medium(0.1f, {vec3(-1), vec3(1)}, {PhaseKind::henyey_greenstein, g})}, {sun_light({0, 0, 1})});
    const float towards = marched(snapshot, settings, {{0, 0, 3}, {0, 0, -1}, 10}).radiance.x;
    const float away = marched(snapshot, settings, {{0, 0, -3}, {0, 0, 1}, 10}).radiance.x;
    EXPECT_NEAR(towards / away / std::pow((1 + g) / (1 - g), 3), 1, 1e-4);
}

TEST(March, ConstantGridEqualsEvenFog) {
    const Light light = sun_light({0.3f, -1, -0.2f});
    const Snapshot grid = snapshot_of({medium_of(unit_volume(64, [](vec3) { return 1.0f; }), 2)}, {light});
    const Snapshot even = snapshot_of({homogeneous_medium(2, unit_box)}, {light});
    for (const vec3 origin : {vec3(0.5f, 0.5f, 3), vec3(0.21f, 0.77f, 3), vec3(0.83f, 0.36f, 3)}) {
        const Ray ray{origin, glm::normalize(vec3(0.02f, -0.03f, -1)), 10};
        const Scatter a = marched(grid, sampled_settings(), ray), b = marched(even, sampled_settings(), ray);
        EXPECT_NEAR(a.radiance.x / b.radiance.x, 1, 0.005);
        EXPECT_NEAR(a.transmittance / b.transmittance, 1, 0.005);
    }
}

TEST(March, TwoHalfDensityCopiesEqualOne) {
    const auto wavy = [](vec3 p) { return 0.5f + 0.5f * std::sin(9 * p.x) * std::cos(7 * p.y + 3 * p.z); };
    const SparseVolume volume = unit_volume(32, wavy);
    const Light light = point_light({0.5f, 1.4f, 0.5f});
    const Snapshot one = snapshot_of({medium_of(volume, 3)}, {light});
    const Snapshot two = snapshot_of({medium_of(volume, 1.5f), medium_of(volume, 1.5f)}, {light});
    const Ray ray{{0.4f, 0.45f, 3}, {0, 0, -1}, 10};
    const Scatter a = marched(one, sampled_settings(), ray), b = marched(two, sampled_settings(), ray);
    EXPECT_NEAR(a.radiance.x / b.radiance.x, 1, 1e-4);
    EXPECT_NEAR(a.transmittance / b.transmittance, 1, 1e-4);
}

TEST(March, ErrorFallsWithTheSteps) {
    // Wavy fog against a run of 512 steps: first order at least (edges), second in smooth fog.
    const auto wavy = [](vec3 p) { return 0.5f + 0.5f * std::sin(9 * p.x) * std::cos(7 * p.y + 13 * p.z); };
    const Snapshot snapshot = snapshot_of({medium_of(unit_volume(64, wavy), 3)}, {sun_light({0.3f, -1, 0.1f})});
    std::vector<Ray> rays;
    for (int i = 0; i < 256; ++i) {
        const Sample2 at = sample2(i, 5);
        rays.push_back({{0.1f + 0.8f * at.x, 0.1f + 0.8f * at.y, 3}, {0, 0, -1}, 10});
    }
    const auto run = [&](float share) {
        Settings settings = sampled_settings();
        settings.march.step_share = share, settings.march.step_voxels = 64, settings.march.step_depth = 10;
        return marched(snapshot, settings, rays);
    };
    const std::vector<Scatter> fine = run(1.0f / 512);
    const auto error = [&](float share) {
        const std::vector<Scatter> coarse = run(share);
        double sum = 0;
        for (size_t i = 0; i < rays.size(); ++i) sum += std::pow(coarse[i].radiance.x - fine[i].radiance.x, 2);
        return std::sqrt(sum / rays.size());
    };
    // Least squares line through log2 error over log2 steps.
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int level = 2; level <= 8; ++level) {
        const double e = std::log2(error(1.0f / (1 << level)));
        ++n, x += level, y += e, xx += level * level, xy += level * e;
    }
    EXPECT_LT((n * xy - x * y) / (n * xx - x * x), -0.8);
}

TEST(March, FogWithoutEndKeepsShortStepsInTheScene) {
    // A spot's beam crosses the ray within 4 m of 2 km of thin fog: the preview has to find it.
    Light light = spot_light({0, 2, -3}, {0, -1, 0}, 50, 0.1f, 0.2f);
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.01f)}, {light});
    snapshot.bounds = {vec3(-3, -1, -6), vec3(3, 3, 1)};
    const Ray ray{{0, 0, 0}, {0, 0, -1}, 2000};
    const float exact = marched(snapshot, exact_settings(), ray).radiance.x;
    EXPECT_NEAR(marched(snapshot, settings_for(Quality::preview), ray).radiance.x / exact, 1, 0.1);
}

TEST(March, EveryTermCanBeTurned) {
    Snapshot snapshot =
        snapshot_of({medium_of(unit_volume(32, [](vec3 p) { return p.x; }), 3)}, {sun_light({0, -1, 0})}, vec3(0.2f));
    snapshot.media[0].optics.phase = {PhaseKind::henyey_greenstein, 0.7f};
    snapshot.media[0].optics.emission.radiance = vec3(0.3f);
    const Ray ray{{0.9f, 0.3f, 3}, {0, 0, -1}, 10};
    const float full = marched(snapshot, Settings{}, ray).radiance.x;
    for (const char* change : {"terms.light=off", "terms.light=average", "terms.phase=off", "terms.heterogeneity=off",
                               "terms.emission=off", "terms.ambient=off"}) {
        Settings settings;
        apply_setting(settings, change);
        EXPECT_GT(std::abs(marched(snapshot, settings, ray).radiance.x / full - 1), 0.01) << change;
    }
}

TEST(March, NoFogIsClearAndNoLightIsBlack) {
    const Ray ray{{0, 0, 3}, {0, 0, -1}, 10};
    EXPECT_EQ(marched(snapshot_of({}, {sun_light({0, -1, 0})}), {}, ray).transmittance, 1);
    EXPECT_EQ(marched(snapshot_of({}, {sun_light({0, -1, 0})}), {}, ray).radiance, vec3(0));
    EXPECT_EQ(marched(snapshot_of({homogeneous_medium(1, unit_box)}, {}), {}, ray).radiance, vec3(0));
}
}
}

// How much light scatters more than once: closed forms, light paths, and the path tracer.
#include "base/random.h"
#include "modes/path/path_rays.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "support/random_points.h"
#include "support/tiny_scenes.h"
#include "trace/fluence/light_paths.h"
#include "trace/fluence/scattering_orders.h"
#include "trace/lights/environment.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// A ball of diameter 1 in the unit box, of an optical radius and albedo 0.99.
Medium ball(float optical_radius, float g) {
    const SparseVolume volume = unit_volume(64, [](vec3 p) {
        return std::clamp(0.5f + 64 * (0.484f - glm::length(p - 0.5f)), 0.0f, 1.0f); // a voxel's air around it
    });
    Medium medium = medium_of(volume, optical_radius / 0.484f);
    medium.optics.albedo = vec3(0.99f), medium.optics.phase = {PhaseKind::henyey_greenstein, g};
    return medium;
}

TEST(ScatteringOrders, OfABallAsTheClosedFormSays) {
    // Each within the last digit of w P / (1 - w P) worked out by hand.
    const double expected[][2] = {{0.05, 0.0376}, {0.1, 0.0764}, {0.25, 0.195}, {0.5, 0.408}, {1, 0.880}, {2, 1.949}};
    for (const auto& [radius, ratio] : expected)
        EXPECT_NEAR(multiple_over_single(radius, 0.99), ratio, 6e-4 * (1 + ratio));
    EXPECT_NEAR(multiple_over_single(0.0299999, 0.99), multiple_over_single(0.0300001, 0.99), 1e-6);
    for (const float sigma : {0.1f, 1.0f, 4.0f}) {
        const Medium cube = homogeneous_medium(sigma, {vec3(0), vec3(1)});
        const double measured = measured_ratio(snapshot_of({cube}, {sun_light({0.2f, -1, 0.4f})}), 65536).ratio;
        EXPECT_NEAR(multiple_over_single(cube), measured, 0.12 * measured) << sigma;
    }
    EXPECT_EQ(multiple_over_single(1, 0), 0);
    EXPECT_EQ(multiple_over_single(homogeneous_medium(1)), double(infinity));
}

// Within a tenth of what light paths and path tracing find, give or take three standard errors.
void expect_as_predicted(float optical_radius, float g, int paths, int points, double precision) {
    const double predicted = multiple_over_single(optical_radius, 0.99);
    const Snapshot snapshot = snapshot_of({ball(optical_radius, g)}, {sun_light({0.3f, -1, 0.2f})});
    const ScatteringRatio measured = measured_ratio(snapshot, paths);
    const double spread = measured.high - measured.ratio;
    EXPECT_NEAR(measured.ratio, predicted, 0.1 * predicted + spread);
    EXPECT_LT(spread, precision * predicted) << optical_radius << " g " << g;

    // Power that the ball scatters of light that comes straight from the sun, σ e^-τ, and of all other light, σ 4π L in
    // random directions, at points all over it.
    std::vector<Ray> rays;
    std::vector<double> straight, extinction;
    const Medium& medium = snapshot.media[0];
    for (uint32_t i = 0; i < static_cast<uint32_t>(points); ++i) {
        const Sample2 u = sample2(i, 8);
        const vec3 point(u.x, u.y, random_unit(i, 0, 0, 9));
        extinction.push_back(gray_extinction(medium.optics) * density_at(medium, point));
        straight.push_back(std::exp(-optical_depth(medium, {point, -snapshot.lights[0].direction, infinity})));
        rays.push_back({point, random_direction(i, 10)});
    }
    const std::vector<Scatter> light = path_light(snapshot, rays, all_orders);
    std::vector<double> once, apart;
    for (size_t i = 0; i < rays.size(); ++i) {
        once.push_back(extinction[i] * straight[i]);
        apart.push_back(extinction[i] * 4 * std::numbers::pi * light[i].radiance.x - predicted * once[i]);
    }
    const Mean mean = mean_of(apart);
    const double more = predicted * mean_of(once).value;
    EXPECT_LT(std::abs(mean.value), 0.1 * more + 3 * mean.error) << optical_radius << " g " << g;
    EXPECT_LT(mean.error, precision * more) << optical_radius << " g " << g;
}

class ScatteringOrdersOfBall : public testing::TestWithParam<float> {};
TEST_P(ScatteringOrdersOfBall, AsLightPathsAndPathTracingFind) {
    for (const float g : {0.0f, 0.8f}) expect_as_predicted(GetParam(), g, 131072, 16000, 0.3);
}
TEST_P(ScatteringOrdersOfBall, NightlyAsLightPathsAndPathTracingFindPrecisely) {
    for (const float g : {0.0f, 0.8f}) expect_as_predicted(GetParam(), g, 8 << 20, 1'000'000, 0.03);
}
INSTANTIATE_TEST_SUITE_P(ScatteringOrders, ScatteringOrdersOfBall, testing::Values(0.05f, 0.25f, 0.5f, 1.0f));

TEST(ScatteringOrders, ConfidenceCoversTheTruth) {
    // 95 % of intervals should: of 40, hardly ever less than 33.
    const Snapshot snapshot = snapshot_of({homogeneous_medium(1, {vec3(0), vec3(1)})}, {sun_light({0, -1, 0})});
    const double truth = measured_ratio(snapshot, 1 << 20, 99).ratio;
    int covered = 0;
    for (uint32_t seed = 0; seed < 40; ++seed) {
        const ScatteringRatio ratio = measured_ratio(snapshot, 4096, seed);
        covered += ratio.low <= truth && truth <= ratio.high;
    }
    EXPECT_GE(covered, 33);
    EXPECT_LT(covered, 41);
}

TEST(ScatteringOrders, BoundIsAboveWhatIsMissing) {
    for (const float sigma : {0.1f, 0.5f, 2.0f}) {
        Medium fog = homogeneous_medium(sigma, {vec3(0), vec3(1)});
        fog.optics.albedo = vec3(0.9f);
        const Snapshot snapshot = snapshot_of({fog}, {sun_light({0, -1, 0})});
        const double q = 0.9 * (1 - std::exp(-sigma * std::sqrt(3.0)));
        EXPECT_NEAR(truncation_bound(snapshot, 1), q / (1 - q), 1e-5 * q);
        EXPECT_NEAR(truncation_bound(snapshot, 3), q * q * q / (1 - q), 1e-5 * q);
        EXPECT_GT(truncation_bound(snapshot, 1), measured_ratio(snapshot).high);
    }
    EXPECT_EQ(truncation_bound(snapshot_of({homogeneous_medium(1)}, {}), 1), double(infinity));
    EXPECT_EQ(measured_ratio(snapshot_of({homogeneous_medium(1)}, {})).ratio, 0);
}
}

// Power that fog scatters of light straight from the lights, and its standard error.
Mean scattered_once(const Snapshot& snapshot) {
    constexpr int batches = 16;
    constexpr int64_t each = 4096;
    LightPathRules rules;
    rules.reach = light_reach(snapshot);
    std::vector<double> found;
    for (uint32_t seed = 0; seed < batches; ++seed) {
        LightPathResult result;
        rules.seed = seed;
        trace_light_paths(snapshot, even_strata(snapshot, rules.reach, 1), rules, 0, each, each, result);
        found.push_back(result.scattered_once);
    }
    return mean_of(found);
}

TEST(ScatteringOrders, FogIsFoundInTheMiddleOfALandscape) {
    // A cube of a meter, alone and with two leaves a kilometer away, which shadow nothing: sixteen million times its
    // cross section.
    const std::vector<Medium> cube{homogeneous_medium(1, {vec3(0), vec3(1)})};
    const auto leaf = [](float x) { return quad({x, 0, x}, {0.1f, 0, 0}, {0, 0, 0.1f}); };
    Light soft = sun_light({0.2f, -1, 0.4f});
    soft.angle = 0.1f;
    const auto expect_alike = [&](const std::vector<Light>& lights, std::shared_ptr<const Environment> sky) {
        Snapshot alone = snapshot_of(cube, lights);
        TestScene wide = make_scene(cube, lights, {leaf(-2000), leaf(2000)});
        alone.environment = wide.snapshot.environment = std::move(sky);
        const Mean expected = scattered_once(alone), found = scattered_once(wide.snapshot);
        EXPECT_NEAR(found.value, expected.value, 4 * std::hypot(found.error, expected.error));
        EXPECT_LT(found.error, 0.02 * expected.value);
        const ScatteringRatio ratio = measured_ratio(wide.snapshot, 65536), truth = measured_ratio(alone, 65536);
        EXPECT_NEAR(ratio.ratio, truth.ratio, ratio.high - ratio.low + truth.high - truth.low);
        EXPECT_LT(ratio.high, 1.2 * truth.ratio);
    };
    BackgroundState sky;
    sky.color = vec3(1);
    expect_alike({sun_light({0.2f, -1, 0.4f})}, nullptr);
    expect_alike({soft}, nullptr);
    expect_alike({}, make_environment(sky));
}

TEST(ScatteringOrders, NothingIsCertainIfNoPathMeetsTheFog) {
    // A lamp in a closed box.
    const TestScene scene = make_scene({homogeneous_medium(1, {vec3(10), vec3(11)})}, {point_light(vec3(0), 1)},
                                       {box_of(vec3(-1), vec3(1))});
    EXPECT_EQ(measured_ratio(scene.snapshot).ratio, 0);
    EXPECT_EQ(measured_ratio(scene.snapshot).high, double(infinity));
}
}

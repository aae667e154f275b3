// Soft lights where shadows are cut out exactly: in steps between them, and in the exact march.

#include "base/random.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/lights/light_ray.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};

// Each ray once per sample, with the place of that sample; the mean.
dvec3 mean_over_samples(const Snapshot& snapshot, const Settings& settings, const Ray& ray, uint32_t samples) {
    const ScatterFunction scatter = find_mode("march").prepare(View{}, snapshot, settings, nullptr);
    dvec3 sum(0);
    for (uint32_t first = 0; first < samples; first += 16) {
        const std::vector<Ray> rays(16, ray);
        uint32_t ids[16];
        SampleIndex sample_indices[16];
        Scatter results[16];
        for (uint32_t i = 0; i < 16; ++i) ids[i] = hash(first + i, 4u), sample_indices[i] = {77, first + i};
        scatter({.rays = rays, .ids = ids, .sample_indices = sample_indices}, results);
        for (const Scatter& result : results) sum += dvec3(result.radiance);
    }
    return sum / double(samples);
}

class SoftLights : public testing::TestWithParam<Visibility> {
protected:
    static Settings settings() { return GetParam() == Visibility::exact ? exact_settings() : sliced_settings(); }
};
INSTANTIATE_TEST_SUITE_P(March, SoftLights, testing::Values(Visibility::intervals, Visibility::exact));

TEST_P(SoftLights, SoftSunIsTheMeanOverItsDisc) {
    // Edge at x = 0.4, 1.7 m above a level ray through thin fog: what counts is the mean lit length. Brute force over
    // 256² directions of the disc.
    Light light = sun_light({0.2f, -1, 0});
    light.angle = 0.1f;
    const TestScene stage = make_scene({homogeneous_medium(1e-3f, unit_box)}, {light}, {roof(0.4f, 2)});
    const Ray ray{{1, 0.3f, 0.5f}, {-1, 0, 0}, 1};
    double mean = 0;
    constexpr int n = 256;
    for (int i = 0; i < n * n; ++i) {
        const vec2 u((i % n + 0.5f) / n, (static_cast<float>(i / n) + 0.5f) / n);
        const vec3 direction = ray_to_light(light, vec3(0), u).direction;
        const double edge = 0.4 - 1.7 * direction.x / direction.y; // x from which on the ray is lit
        mean += 1 - std::clamp(edge, 0.0, 1.0);
    }
    mean /= n * n;
    Light hard = light;
    hard.angle = 0;
    const double full = marched(snapshot_of(stage.snapshot.media, {hard}), settings(), ray).radiance.x;
    const double found = mean_over_samples(stage.snapshot, settings(), ray, 1024).x;
    EXPECT_GT(mean, 0.1);
    EXPECT_LT(mean, 0.9);
    EXPECT_NEAR(found / full, mean, 2e-3); // e^-0.001 along the ray, and 1024 stratified samples
}

TEST_P(SoftLights, SoftLampAgreesWithShadowRaysToItsBall) {
    Light light = point_light({0.4f, 2, 0.5f}, 3);
    light.radius = 0.1f;
    const TestScene stage = make_scene({homogeneous_medium(0.5f, unit_box)}, {light}, {roof(0.3f, 1.2f)});
    const Ray ray{{1, 0.3f, 0.5f}, {-1, 0, 0}, 1};
    Settings rays = exact_settings();
    rays.march.visibility = Visibility::rays, rays.march.step_share = 1.0f / 256;
    const double sampled = mean_over_samples(stage.snapshot, rays, ray, 512).x;
    const double sliced = mean_over_samples(stage.snapshot, settings(), ray, 1024).x;
    EXPECT_NEAR(sliced / sampled, 1, 2e-3); // radius²/distance² of the penumbra's part, and 131072 shadow rays
    light.radius = 0;
    TestScene hard = make_scene(stage.snapshot.media, {light}, {roof(0.3f, 1.2f)});
    EXPECT_GT(std::abs(marched(hard.snapshot, settings(), ray).radiance.x / sliced - 1), 1e-4);
}

TEST_P(SoftLights, ManyPointsAtOnceAreTheMeanOfAsManySamples) {
    // 16 samples of 8 points ask for the same 128 points as 128 samples of one.
    Light light = point_light({0.4f, 2, 0.5f}, 3);
    light.radius = 0.2f;
    const TestScene stage =
        make_scene({homogeneous_medium(0.5f, unit_box)}, {light}, {roof(0.3f, 1.2f), roof(0.6f, 1.4f)});
    const Ray ray{{1, 0.3f, 0.5f}, {-1, 0, 0}, 1};
    Settings many = settings();
    many.terms.light_points = 8;
    const double together = mean_over_samples(stage.snapshot, many, ray, 16).x;
    const double apart = mean_over_samples(stage.snapshot, settings(), ray, 128).x;
    EXPECT_NEAR(together / apart, 1, 1e-6);
    EXPECT_GT(std::abs(mean_over_samples(stage.snapshot, settings(), ray, 16).x / apart - 1), 1e-5);

    // Shadow rays to many points in each step: the same light with less noise.
    Settings rays = exact_settings();
    rays.march.visibility = Visibility::rays, rays.march.step_share = 1.0f / 256, rays.terms.light_points = 64;
    EXPECT_NEAR(mean_over_samples(stage.snapshot, rays, ray, 16).x / apart, 1, 0.01);
}
}
}

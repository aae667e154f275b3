// Steps between exact shadows: against the exact march, in every kind of fog and light.
#include "integrate/ray_batch.h"
#include "modes/busy_stage.h"
#include "modes/limitation.h"
#include "modes/march/limitations.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};
const double four_pi = 4 * std::acos(-1.0);

TEST(MarchSlices, SunPastAnEdgeIsItsClosedForm) {
    // Sun straight down on the unit box, shade over x < 0.4: a level ray at height y from x = 1 to 0 sees light until
    // there, L = w p E e^(-s(1-y)) (1 - e^(-s·0.6)).
    const float height = 0.3f;
    const TestScene stage =
        make_scene({homogeneous_medium(1.5f, unit_box)}, {sun_light({0, -1, 0}, 3)}, {roof(0.4f, 2)});
    const Scatter result = marched(stage.snapshot, settings_for(Quality::preview), {{2, height, 0.5f}, {-1, 0, 0}, 10});
    const double lit = 1 - double(0.4f - 50 + 50);
    const double expected = 3 / four_pi * std::exp(-1.5 * (1 - double(height))) * (1 - std::exp(-1.5 * lit));
    EXPECT_NEAR(result.radiance.x / expected, 1, 2e-6); // rounding to float
    EXPECT_NEAR(result.transmittance / std::exp(-1.5), 1, 2e-6);
}

// The greatest difference from the exact march, as a share of its brightest ray.
double worst(const TestScene& stage, const Settings& settings, const std::vector<Ray>& rays) {
    const std::vector<Scatter> exact = marched(stage.snapshot, exact_settings(), rays);
    const std::vector<Scatter> found = marched(stage.snapshot, settings, rays);
    float difference = 0, brightest = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        difference = std::max(difference, max_component(glm::abs(exact[i].radiance - found[i].radiance)));
        brightest = std::max(brightest, max_component(exact[i].radiance));
    }
    EXPECT_GT(brightest, 0);
    return difference / brightest;
}

TEST(MarchSlices, ApproachesTheExactMarchBySecondOrder) {
    // Fog is all that steps sample: midpoints, where shadow rays leave an error of first order.
    const TestScene stage = busy_scene();
    const std::vector<Ray> rays = busy_rays(64);
    const std::vector<Scatter> exact = marched(stage.snapshot, exact_settings(), rays);
    std::vector<double> errors;
    for (const float share : {1.0f / 16, 1.0f / 64, 1.0f / 256}) {
        Settings settings = sliced_settings();
        settings.march.step_share = share, settings.march.step_voxels = 64, settings.march.step_depth = 10;
        errors.push_back(rms_difference(marched(stage.snapshot, settings, rays), exact) / mean_of(exact));
    }
    EXPECT_LT(errors[1], errors[0] / 4); // the kinks between voxels are of first order, but small
    EXPECT_LT(errors[2], errors[1] / 4);
    EXPECT_LT(errors[2], 2e-4);
}

TEST(MarchSlices, EveryKindOfLightInAGrid) {
    const std::vector<Medium> fog{medium_of(unit_volume(24, wavy), 2)};
    Light spot = spot_light({0.3f, 1.5f, 0.4f}, {0.1f, -1, 0.1f}, 2, 0.3f, 0.5f);
    for (const Light& light : {sun_light({0.3f, -1, 0.1f}), point_light({0.4f, 0.8f, 0.6f}), spot})
        EXPECT_LT(
            worst(make_scene(fog, {light}, {roof(0.35f, 1.2f), box_of(vec3(0.5f, 0.4f, 0.3f), vec3(0.7f, 0.5f, 0.6f))}),
                  sliced_settings(), busy_rays(64)),
            2e-3);
}

TEST(MarchSlices, SheetsOfAlphaLetTheirShareThrough) {
    Mesh sheet = roof(50, 2);
    sheet.material = 0; // half transparent
    const Ray ray{{0.5f, 0.3f, 2}, {0, 0, -1}, 10};
    const std::vector<Medium> fog{homogeneous_medium(1, unit_box)};
    const float open =
        marched(make_scene(fog, {sun_light({0, -1, 0})}, {}).snapshot, sliced_settings(), ray).radiance.x;
    const TestScene under = make_scene(fog, {sun_light({0, -1, 0})}, {sheet});
    EXPECT_NEAR(marched(under.snapshot, sliced_settings(), ray).radiance.x / open, 0.5, 1e-4); // 512 steps
    const Limitations said = find_mode("march").limitations(View{}, under.snapshot, sliced_settings());
    EXPECT_TRUE(has_limitation(said, limitation::sampled_alpha_shadows));
}

TEST(MarchSlices, SurfacesWithAlphaAreSampledBesideOpaqueOnes) {
    // An opaque and a half transparent sheet over parts of the ray: lit by 0, a half and all of the light.
    Mesh half = quad({0.2f, 2, -50}, {0.5f, 0, 0}, {0, 0, 100});
    half.material = 0;
    const TestScene stage =
        make_scene({homogeneous_medium(1e-3f, unit_box)}, {sun_light({0, -1, 0})}, {roof(0.2f, 1.5f), half});
    const Ray ray{{1, 0.3f, 0.5f}, {-1, 0, 0}, 1};
    const float open = marched(make_scene({homogeneous_medium(1e-3f, unit_box)}, {sun_light({0, -1, 0})}, {}).snapshot,
                               sliced_settings(), ray)
                           .radiance.x;
    EXPECT_NEAR(marched(stage.snapshot, sliced_settings(), ray).radiance.x / open, 0.3 + 0.25, 2.0 / 512);
}

TEST(MarchSlices, LightsWithoutShadowsPassThroughSurfaces) {
    Light light = sun_light({0, -1, 0});
    light.shadows = false;
    const Ray ray{{0.5f, 0.3f, 2}, {0, 0, -1}, 10};
    const std::vector<Medium> fog{homogeneous_medium(6, unit_box)};
    const TestScene under = make_scene(fog, {light}, {roof(50, 2)});
    const float expected = marched(snapshot_of(fog, {light}), sliced_settings(), ray).radiance.x;
    EXPECT_GT(expected, 0);
    EXPECT_EQ(marched(under.snapshot, sliced_settings(), ray).radiance.x, expected);
}

TEST(MarchSlices, TheMarchEndsWhereLittlePasses) {
    const Snapshot grid = snapshot_of({medium_of(unit_volume(32, wavy), 20)}, {sun_light({0, -1, 0})});
    Settings settings = sliced_settings();
    settings.march.min_transmittance = 0.1f;
    const Ray far{{0.5f, 0.5f, 2}, {0, 0, -1}, 10};
    const Scatter ended = marched(grid, settings, far), whole = marched(grid, sliced_settings(), far);
    EXPECT_LT(ended.radiance.x, whole.radiance.x);
    EXPECT_GT(ended.radiance.x, 0.85f * whole.radiance.x); // at most a tenth is left out
    EXPECT_LT(ended.steps, whole.steps);
}

TEST(MarchSlices, PartsOfTheLightsAddUp) {
    const TestScene stage = busy_scene();
    TestScene dark = busy_scene();
    dark.snapshot.lights.clear();
    const std::vector<Ray> rays = busy_rays(16);
    const Settings settings = settings_for(Quality::preview);
    std::vector<Scatter> results(16);
    constexpr size_t count = part_count(2);
    std::vector<vec3> parts(16 * count, vec3(0));
    const std::vector<uint32_t> ids(16, 7);
    find_mode("march").prepare(View{}, stage.snapshot, settings, nullptr)({.rays = rays, .ids = ids, .parts = parts},
                                                                          results);
    const std::vector<Scatter> glow = marched(dark.snapshot, settings, rays);
    for (size_t i = 0; i < 16; ++i) {
        const vec3* of_ray = &parts[count * i];
        const vec3 glowing = of_ray[2] + of_ray[3];
        EXPECT_NEAR((of_ray[0] + of_ray[1] + glowing).x / results[i].radiance.x, 1, 1e-5);
        EXPECT_NEAR(glowing.x / glow[i].radiance.x, 1, 1e-5);
    }
}
}
}

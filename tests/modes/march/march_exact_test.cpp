// The exact march against closed forms, quadrature of the light equation, and the sampled march.
#include "base/gauss_legendre.h"
#include "integrate/ray_batch.h"
#include "modes/busy_stage.h"
#include "modes/limitation.h"
#include "modes/march/limitations.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "support/expect.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "trace/occlusion/occluders.h"
#include "trace/view.h"

#include "base/parallel.h"
#include "trace/lights/light_ray.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};
const double four_pi = 4 * std::acos(-1.0);

TEST(MarchExact, SunPastAnEdgeIsItsClosedForm) {
    // Sun straight down on the unit box, shade over x < 0.4: a level ray at height y from x = 1 to 0 sees light until
    // there, L = w p E e^(-s(1-y)) (1 - e^(-s·0.6)).
    const float extinction = 1.5f, height = 0.3f;
    const TestScene stage =
        make_scene({homogeneous_medium(extinction, unit_box)}, {sun_light({0, -1, 0}, 3)}, {roof(0.4f, 2)});
    const Scatter result = marched(stage.snapshot, exact_settings(), {{2, height, 0.5f}, {-1, 0, 0}, 10});
    const double lit = 1 - double(0.4f - 50 + 50);
    const double expected = 3 / four_pi * std::exp(-1.5 * (1 - double(height))) * (1 - std::exp(-1.5 * lit));
    EXPECT_NEAR(result.radiance.x / expected, 1, 1e-6);
    EXPECT_NEAR(result.transmittance / std::exp(-1.5), 1, 1e-6);
}

TEST(MarchExact, SlantedSunThroughASlitMatchesQuadrature) {
    // A slit of 0.2 in a roof at y = 1; the sun's direction has x/y = 1/2, so light at height 0 comes from x + 1/2.
    const Light light = sun_light({-0.5f, -1, 0}, 2);
    const TestScene stage =
        make_scene({homogeneous_medium(0.8f)}, {light},
                   {quad({-40, 1, -40}, {40, 0, 0}, {0, 0, 80}), quad({0.25f, 1, -40}, {40, 0, 0}, {0, 0, 80})});
    Settings settings = exact_settings();
    settings.terms.light = LightTransmittance::off; // the sun's way through fog without end is black
    const Scatter result = marched(stage.snapshot, settings, {{-3, 0, 0}, {1, 0, 0}, 6});
    const double expected = 2 / four_pi * (std::exp(-0.8f * 2.5) - std::exp(-0.8f * 2.75));
    EXPECT_NEAR(result.radiance.x / expected, 1, 1e-6);
}

TEST(MarchExact, PointLightPastAnEdgeMatchesQuadrature) {
    // The lamp hangs 2 m above the ray at x = 1, the shade's edge at x = 0.5 and half the height: it throws x < 0.
    for (const float g : {0.0f, 0.6f, -0.9f}) {
        const Light light = point_light({1, 2, 0}, 7);
        const TestScene stage = make_scene({homogeneous_medium(0.3f, everywhere(), {PhaseKind::henyey_greenstein, g})},
                                           {light}, {roof(0.5f, 1)});
        const Ray ray{{-2, 0, 0}, {1, 0, 0}, 8};
        const double s = double(0.3f), gg = g;
        const auto integrand = [&](double t) {
            const double x = t - 2, away = std::hypot(x - 1, 2), cosine = (1 - x) / away;
            const double phase = (1 - gg * gg) / (four_pi * std::pow(1 + gg * gg - 2 * gg * cosine, 1.5));
            return s * phase * 7 / (away * away) * std::exp(-s * (t + away));
        };
        EXPECT_NEAR(marched(stage.snapshot, exact_settings(), ray).radiance.x / integral(integrand, 2, 8), 1, 1e-6);
    }
}

TEST(MarchExact, SpotWithRangeAndEdgeMatchesQuadrature) {
    Light light = spot_light({0, 3, 0}, {0, -1, 0}, 40, 0.15f, 0.4f);
    light.range = 3.2f;
    const TestScene stage = make_scene({homogeneous_medium(0.2f)}, {light}, {roof(-0.25f, 1.5f)}); // throws x < -0.5
    const Ray ray{{-4, 0, 0}, {1, 0, 0}, 8};
    const double inner = std::cos(double(0.15f)), outer = std::cos(double(0.4f)), range = light.range;
    const auto integrand = [&](double t) {
        const double x = t - 4, squared = x * x + 9, away = std::sqrt(squared), cosine = 3 / away;
        const double edge = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
        const double window = std::clamp(1 - std::pow(away / range, 4), 0.0, 1.0);
        return 0.2f / four_pi * 40 / squared * edge * edge * window * std::exp(-double(0.2f) * (t + away));
    };
    const double rim = std::sqrt(range * range - 9), inside = 3 * std::tan(double(0.15f));
    const double expected = integral(integrand, 3.5, 4 - inside) + integral(integrand, 4 - inside, 4 + inside) +
                            integral(integrand, 4 + inside, 4 + rim);
    EXPECT_NEAR(marched(stage.snapshot, exact_settings(), ray).radiance.x / expected, 1, 1e-6);
}

TEST(MarchExact, NarrowSpotsAreAsBrightAsWide) {
    // Down to the narrowest cone, along its axis: as if the light shone all around.
    const Ray ray{{0, 0, 0}, {0, 1, 0}, 2};
    const auto light_of = [&](const Light& light) {
        const TestScene stage = make_scene({homogeneous_medium(0.2f)}, {light}, {});
        return double(marched(stage.snapshot, exact_settings(), ray).radiance.x);
    };
    const double all_around = light_of(point_light({0, 3, 0}, 40));
    for (const float degrees : {0.05f, 0.07f, 0.2f, 5.0f})
        for (const float inner : {0.0f, 1.0f})
            EXPECT_NEAR(
                light_of(spot_light({0, 3, 0}, {0, -1, 0}, 40, inner * glm::radians(degrees), glm::radians(degrees))) /
                    all_around,
                1, 1e-4)
                << degrees;
}

TEST(MarchExact, SoftBeamsFromTheSideMatchQuadrature) {
    // Across the axis 8 m from the light, and aslant, where the light's nearest point does not divide the beam: one
    // part at preview's bounds however wide the beam, and one at the reference's for the narrowest.
    const double s = double(0.01f);
    for (const float degrees : {0.2f, 0.57f, 1.0f, 5.0f, 10.0f, 30.0f})
        for (const float slope : {0.0f, 0.5f})
            for (const float inner : {0.0f, 0.9f}) {
                const float edge = glm::radians(degrees);
                const Light light = spot_light({0, 0, 0}, {0, -1, 0}, 40, inner * edge, edge);
                const TestScene stage = make_scene({homogeneous_medium(0.01f)}, {light}, {});
                const vec3 direction = glm::normalize(vec3(1, slope, 0));
                const Ray ray{vec3(0, -8, 0) - 20.0f * direction, direction, 40};
                const double outer = std::cos(double(edge)), full = std::cos(double(inner * edge));
                const auto integrand = [&](double t) {
                    const dvec3 point = dvec3(ray.origin) + t * dvec3(direction);
                    const double away = glm::length(point);
                    const double lit = std::clamp((-point.y / away - outer) / (full - outer), 0.0, 1.0);
                    return s / four_pi * 40 / (away * away) * lit * lit * std::exp(-s * (t + away));
                };
                const double half = 1.5 * 8 * std::tan(double(edge)), near = std::max(20 - half, 0.0);
                const double expected = integral(integrand, near, std::min(20 + 2 * half, 40.0), 4000);
                Settings coarse;
                coarse.march.visibility = Visibility::exact;
                for (const Settings& settings : {exact_settings(), coarse})
                    EXPECT_NEAR(marched(stage.snapshot, settings, ray).radiance.x / expected, 1, 1e-3)
                        << degrees << ' ' << slope << ' ' << inner;
            }
}

TEST(MarchExact, RayThroughTheLightItself) {
    // Inside 0.1 mm the inverse square law is held: s/(4π)·(2·∫ from 1e-4 + 2·1e-4/1e-8), with e^(-s(t+r)) in thin fog.
    const double s = 1e-3f, reach = Light{}.core;
    const TestScene stage = make_scene({homogeneous_medium(1e-3f)}, {point_light({0, 0, 0})}, {});
    const double expected = s / four_pi * (2 * (1 / reach - 1.0 / 2) + 2 / reach) * std::exp(-s * 2);
    const Scatter result = marched(stage.snapshot, exact_settings(), {{-2, 0, 0}, {1, 0, 0}, 4});
    EXPECT_NEAR(result.radiance.x / expected, 1, 1e-5); // e^-st is not quite constant over what matters
}

TEST(MarchExact, SunInHeightFogMatchesQuadrature) {
    Medium fog;
    fog.density.kind = DensityKind::height, fog.optics = {vec3(0.4f), vec3(0.9f), {PhaseKind::isotropic, 0}, vec3(0)};
    fog.density.height_base = 0.5f, fog.density.height_falloff = 2;
    const Light light = sun_light({0.6f, -0.8f, 0}, 5);
    const TestScene stage = make_scene({fog}, {light}, {roof(-30, 30)}); // above everything that counts
    const vec3 direction = glm::normalize(vec3(2, 1, 0));
    const Ray ray{{-30, -2, 0}, direction, 30};
    const double slope = direction.y, s = double(0.4f), up = -double(light.direction.y);
    const auto density = [&](double y) { return std::exp(-std::max(y - 0.5, 0.0) / 2); };
    const auto column_above = [&](double y) { return y < 0.5 ? 0.5 - y + 2 : 2 * std::exp(-(y - 0.5) / 2); };
    const auto integrand = [&](double t) {
        const double y = -2 + slope * t;
        const double depth = s * (column_above(-2) - column_above(y)) / slope + s * column_above(y) / up;
        return s * density(y) * double(0.9f) * 5 / four_pi * std::exp(-depth);
    };
    // The edge at height 30 is thrown along (0.6, -0.8): the ray crosses its shadow where x - 0.75·(30 - y) = -30.
    const double run = double(-light.direction.x / light.direction.y);
    const double from = (30 - 30 + run * 32) / (double(direction.x) + run * slope);
    const double base = 2.5 / slope;
    const double expected =
        from < base ? integral(integrand, from, base) + integral(integrand, base, 30) : integral(integrand, from, 30);
    ASSERT_LT(from, 29);
    EXPECT_NEAR(marched(stage.snapshot, exact_settings(), ray).radiance.x / expected, 1, 1e-5);
}

TEST(MarchExact, GlowNeedsNoLight) {
    // Ambient light or, without scattering, emission under a closed roof: (a·A + e/s)(1 - e^-s) for each medium, by its
    // share of both.
    std::vector<Medium> media{homogeneous_medium(2, unit_box), homogeneous_medium(1, unit_box)};
    const double covered = 1 - std::exp(-3.0);
    const auto seen = [&](vec3 ambient) {
        const TestScene stage = make_scene(media, {sun_light({0, -1, 0})}, {roof(50, 2)}, ambient);
        return marched(stage.snapshot, exact_settings(), {{0.5f, 0.5f, 3}, {0, 0, -1}, 10}).radiance;
    };
    media[0].optics.albedo = vec3(0.5f);
    expect_near(seen({1, 2, 0}), vec3(dvec3(1, 2, 0) * ((2 * 0.5 + 1) / 3 * covered)), 1e-6f);
    media[0].optics.albedo = media[1].optics.albedo = vec3(0), media[1].optics.emission.radiance = {0.25f, 0.5f, 1};
    expect_near(seen(vec3(0)), vec3(dvec3(0.25, 0.5, 1) / 3.0 * covered), 1e-6f);
}

TEST(MarchExact, GridFogMatchesMidpointSums) {
    // The light equation by 20000 midpoints with a shadow ray each; borders and edges are off by up to half a step.
    TestScene stage = busy_scene();
    stage.snapshot.ambient = vec3(0);
    const std::vector<Medium>& media = stage.snapshot.media;
    double brightest = 0;
    for (const Ray& ray : busy_rays(4)) {
        constexpr int steps = 20000;
        const double dt = double(ray.t_max) / steps;
        dvec3 expected(0);
        double depth = 0, highest = 0; // the most light a meter adds
        for (int i = 0; i < steps; ++i) {
            const dvec3 before = expected;
            const vec3 point = ray.at(static_cast<float>((i + 0.5) * dt));
            double extinction[2], total = 0;
            for (int m = 0; m < 2; ++m) {
                float x[16], y[16], z[16], density[16];
                std::fill(x, x + 16, point.x), std::fill(y, y + 16, point.y), std::fill(z, z + 16, point.z);
                densities(media[m], x, y, z, density);
                total += extinction[m] = double(gray_extinction(media[m].optics)) * density[0];
            }
            if (total == 0) continue;
            for (const Light& light : stage.snapshot.lights) {
                const LightSample at = arrival(light, point);
                const Ray shadow{point, at.to_light, 0.9999f * at.distance};
                if (at.irradiance.x == 0 || stage.snapshot.occluders->transmission(shadow, 0) == 0) continue;
                const double dimmed = std::exp(-optical_depth(media, {point, at.to_light, at.distance}));
                for (int m = 0; m < 2; ++m)
                    expected += std::exp(-depth - total * dt / 2) * dt * extinction[m] * dimmed *
                                phase_value(media[m].optics.phase, glm::dot(at.to_light, ray.direction)) *
                                dvec3(media[m].optics.albedo) * dvec3(at.irradiance);
            }
            depth += total * dt;
            highest = std::max(highest, (expected.x - before.x) / dt);
        }
        const Scatter result = marched(stage.snapshot, exact_settings(), ray);
        // Half a step at each edge of light, few as they are, and at the two borders of the homogeneous fog.
        EXPECT_NEAR(result.radiance.x, expected.x, 4 * dt / 2 * highest);
        EXPECT_NEAR(result.radiance.z, expected.z, 4 * dt / 2 * highest);
        EXPECT_NEAR(result.transmittance / std::exp(-depth), 1, dt * 0.5);
        brightest = std::max(brightest, expected.x);
    }
    EXPECT_GT(brightest, 0.02);
}

TEST(MarchExact, RaysApproachSlicesAsTheirStepsShrink) {
    const TestScene stage = busy_scene();
    const std::vector<Ray> rays = busy_rays(64);
    const std::vector<Scatter> exact = marched(stage.snapshot, exact_settings(), rays);
    std::vector<double> errors;
    for (const float share : {1.0f / 64, 1.0f / 256, 1.0f / 1024, 1.0f / 4096}) {
        Settings settings = exact_settings();
        settings.march.visibility = Visibility::rays, settings.march.step_share = share;
        settings.march.step_voxels = 64, settings.march.step_depth = 10, settings.march.near_light = 10;
        errors.push_back(rms_difference(marched(stage.snapshot, settings, rays), exact) / mean_of(exact));
    }
    // First order in the step: an edge is missed by a quarter of a step on average.
    for (size_t i = 1; i < errors.size(); ++i) EXPECT_LT(errors[i], 0.5 * errors[i - 1]);
    EXPECT_LT(errors.back(), 1e-3);
}

TEST(MarchExact, HalvingEveryBoundChangesNothing) {
    const TestScene stage = busy_scene();
    const std::vector<Ray> rays = busy_rays(64);
    Settings halved = exact_settings();
    halved.march.step_depth /= 2, halved.march.step_voxels /= 2, halved.march.step_share /= 2;
    halved.march.near_light /= 2;
    const std::vector<Scatter> a = marched(stage.snapshot, exact_settings(), rays);
    const std::vector<Scatter> b = marched(stage.snapshot, halved, rays);
    EXPECT_LT(rms_difference(a, b) / mean_of(b), 2e-5);
    int more = 0;
    for (size_t i = 0; i < a.size(); ++i) more += b[i].steps > a[i].steps;
    EXPECT_GT(more, 60); // it did halve
}

TEST(MarchExact, ASmallDenseGridDrawsItsShadowInWideHaze) {
    // Kilometers of haze under a striped grid of a meter: its shadow on the ray has to be found and resolved.
    const auto stripes = [](vec3 p) { return 0.5f + 0.5f * std::sin(40 * p.x); };
    std::vector<Medium> media{medium_of(unit_volume(32, stripes), 8),
                              homogeneous_medium(1e-3f, {vec3(-900), vec3(900, 2, 900)})};
    Light lamp = point_light({0.5f, 3, 0.5f}, 5);
    for (const Light& light : {sun_light({0.2f, -1, 0}), lamp}) {
        const Ray ray{{-850, -1, 0.5f}, {1, 0, 0}, 1700};
        const Snapshot snapshot = snapshot_of(media, {light});
        const auto integrand = [&](double t) {
            const vec3 point(static_cast<float>(t - 850), -1, 0.5f);
            const LightSample at = arrival(light, point);
            return double(1e-3f) / four_pi * at.irradiance.x *
                   std::exp(-double(1e-3f) * t - optical_depth(media, {point, at.to_light, at.distance}));
        };
        // What the grid takes away is what matters: it stands within two meters of the middle.
        const std::vector<Medium> haze{media[1]};
        const double with = integral(integrand, 0, 846, 2000) + integral(integrand, 846, 854, 4000) +
                            integral(integrand, 854, 1700, 2000);
        const double clear = marched(snapshot_of(haze, {light}), exact_settings(), ray).radiance.x;
        const double found = marched(snapshot, exact_settings(), ray).radiance.x;
        EXPECT_LT(with, clear * 0.9999);
        EXPECT_NEAR((clear - found) / (clear - with), 1, 1e-2) << clear << ' ' << with << ' ' << found;
    }
}

TEST(MarchExact, SheetsOfAlphaLetTheirShareThrough) {
    Mesh sheet = roof(50, 2);
    sheet.material = 0; // half transparent
    const Ray ray{{0.5f, 0.3f, 2}, {0, 0, -1}, 10};
    const std::vector<Medium> fog{homogeneous_medium(1, unit_box)};
    const float open = marched(make_scene(fog, {sun_light({0, -1, 0})}, {}).snapshot, exact_settings(), ray).radiance.x;
    const TestScene under = make_scene(fog, {sun_light({0, -1, 0})}, {sheet});
    EXPECT_NEAR(marched(under.snapshot, exact_settings(), ray).radiance.x / open, 0.5, 1e-6);
    Settings settings = exact_settings();
    const Limitations said = find_mode("march").limitations(View{}, under.snapshot, settings);
    EXPECT_TRUE(has_limitation(said, limitation::sampled_alpha_shadows));
}

TEST(MarchExact, LightsWithoutShadowsAndTheEndOfTheMarch) {
    Light light = sun_light({0, -1, 0});
    light.shadows = false;
    const Ray ray{{0.5f, 0.3f, 2}, {0, 0, -1}, 10};
    const std::vector<Medium> fog{homogeneous_medium(6, unit_box)};
    const TestScene under = make_scene(fog, {light}, {roof(50, 2)});
    const float expected = marched(snapshot_of(fog, {light}), exact_settings(), ray).radiance.x;
    EXPECT_GT(expected, 0);
    EXPECT_EQ(marched(under.snapshot, exact_settings(), ray).radiance.x, expected);

    // A grid ends the march in the cell where less than a hundredth passes.
    const Snapshot grid = snapshot_of({medium_of(unit_volume(32, wavy), 20)}, {light});
    Settings settings = exact_settings();
    settings.march.min_transmittance = 0.01f;
    const Ray far{{0.5f, 0.5f, 2}, {0, 0, -1}, 10};
    const Scatter ended = marched(grid, settings, far), whole = marched(grid, exact_settings(), far);
    EXPECT_LT(ended.transmittance, 0.01f);
    EXPECT_GT(ended.transmittance, 0.01f * std::exp(-20.0f / 32 * std::sqrt(3.0f)));
    EXPECT_LT(whole.transmittance, ended.transmittance);
    EXPECT_LT(ended.radiance.x, whole.radiance.x);
    EXPECT_GT(ended.radiance.x, 0.9f * whole.radiance.x);
}

TEST(MarchExact, MarchesFromDrawnNodesAreRightOnTheAverage) {
    TestScene stage = busy_scene();
    stage.snapshot.ambient = vec3(0);
    const std::vector<Ray> rays = busy_rays(16);
    const std::vector<uint32_t> ids(16, 7);
    const auto prepared = [&](int marches) {
        Settings settings = exact_settings();
        settings.march.light_marches = marches;
        return find_mode("march").prepare(View{}, stage.snapshot, settings, nullptr);
    };
    const auto of_jitter = [&](const ScatterFunction& scatter, float jitter) {
        const std::vector<float> jitters(16, jitter);
        std::vector<Scatter> results(16);
        scatter({.rays = rays, .ids = ids, .jitter = jitters}, results);
        return results;
    };
    const std::vector<Scatter> all = of_jitter(prepared(0), 0.5f), enough = of_jitter(prepared(65536), 0.25f);
    const ScatterFunction drawn = prepared(8);
    // A sum over shifts of one node after the other is the sum over nodes where all shifts come equally often: with 512
    // of them, each node is off by 1/512 of a drawing at most, and errors of neighbors cancel.
    constexpr int shifts = 512;
    std::vector<double> mean(16, 0.0);
    double spread = 0, steps = 0, all_steps = 0;
    for (int k = 0; k < shifts; ++k) {
        const std::vector<Scatter> some = of_jitter(drawn, (static_cast<float>(k) + 0.5f) / shifts);
        for (size_t i = 0; i < 16; ++i) {
            mean[i] += double(some[i].radiance.x) / shifts, steps += some[i].steps;
            EXPECT_EQ(some[i].transmittance, all[i].transmittance);
            const double off = std::abs(some[i].radiance.x - all[i].radiance.x);
            if (off > 0) spread = std::max(spread, off / all[i].radiance.x);
        }
    }
    for (size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(enough[i].radiance, all[i].radiance);
        EXPECT_NEAR(mean[i], all[i].radiance.x, 2e-3 * all[i].radiance.x);
        all_steps += all[i].steps;
    }
    EXPECT_GT(spread, 1e-3); // one drawing alone is not exact, and takes less
    EXPECT_LT(steps / shifts, 0.5 * all_steps);
}

TEST(MarchExact, PartsOfTheLightsAddUpAndThreadsDoNotMatter) {
    const TestScene stage = busy_scene();
    const std::vector<Ray> rays = busy_rays(64);
    const ScatterFunction scatter = find_mode("march").prepare(View{}, stage.snapshot, exact_settings(), nullptr);
    std::vector<Scatter> alone(64), together(64);
    constexpr size_t count = part_count(2);
    std::vector<vec3> parts(64 * count, vec3(0));
    const std::vector<uint32_t> ids(16, 7);
    for (size_t b = 0; b < 4; ++b)
        scatter({.rays = std::span(rays).subspan(16 * b, 16),
                 .ids = ids,
                 .parts = std::span(parts).subspan(16 * count * b, 16 * count)},
                std::span(alone).subspan(16 * b, 16));
    parallel_for(4, [&](int64_t b) {
        scatter({.rays = std::span(rays).subspan(16 * b, 16), .ids = ids}, std::span(together).subspan(16 * b, 16));
    });
    TestScene dark = busy_scene();
    dark.snapshot.lights.clear();
    const std::vector<Scatter> glow = marched(dark.snapshot, exact_settings(), rays);
    for (size_t i = 0; i < 64; ++i) {
        EXPECT_EQ(alone[i].radiance, together[i].radiance);
        EXPECT_EQ(alone[i].transmittance, together[i].transmittance);
        const vec3* of_ray = &parts[count * i];
        const vec3 glowing = of_ray[2] + of_ray[3], sum = of_ray[0] + of_ray[1] + glowing;
        EXPECT_NEAR(sum.x / alone[i].radiance.x, 1, 1e-6);
        EXPECT_NEAR(glowing.x / glow[i].radiance.x, 1, 1e-6);
    }
}
}
}

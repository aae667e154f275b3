// Light that scatters more than once, by the grid of fluence: closed forms, conservation, and path tracing.
#include "base/clock.h"
#include "base/gauss_legendre.h"
#include "base/parallel.h"
#include "base/random.h"
#include "modes/ambient_limitations.h"
#include "modes/froxel/froxel_fixtures.h"
#include "modes/froxel/settings.h"
#include "modes/mode.h"
#include "modes/path/path_rays.h"
#include "modes/settings.h"
#include "modes/shared_limitations.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/threads.h"
#include "support/tiny_scenes.h"
#include "trace/fluence/fluence.h"
#include "trace/fluence/light_paths.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_transmittance.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box unit_box{vec3(0), vec3(1)};

FluenceSettings grid_settings(int orders, int resolution, int paths) { return {orders, resolution, paths}; }

// ∫ dV / (4π r²) over the cube of side 1, r from its middle: the mean distance from there to its sides.
double mean_inverse_square() {
    // Six faces: the distance to a point of one, times the solid angle ½ / r³ dx dy.
    const auto across = [](double x) {
        return integral([&](double y) { return 0.5 / (x * x + y * y + 0.25); }, -0.5, 0.5, 50);
    };
    return 6 * integral(across, -0.5, 0.5, 50) / (4 * std::numbers::pi);
}

TEST(Fluence, IsWhatThinFogScattersOnce) {
    // A sun of 1 lux in a cube of optical depth σ << 1: fluence at the middle is σ ∫ dV / (4π r²), flux 0; the grid
    // knows the mean over the eight cells about it.
    constexpr float sigma = 0.01f;
    const Snapshot snapshot = snapshot_of({homogeneous_medium(sigma, unit_box)}, {sun_light({0, -1, 0})});
    const FluenceGrid grid = make_fluence(snapshot, grid_settings(2, 16, 2'000'000));
    const FluenceAt at = fluence_at(grid, vec3(0.5f));
    const double expected = sigma * mean_inverse_square();
    EXPECT_NEAR(at.fluence.x, expected, 0.06 * expected);
    EXPECT_EQ(at.fluence.x, at.fluence.z);
    EXPECT_LT(glm::length(at.flux[0]), 0.08 * expected);
    EXPECT_EQ(fluence_at(grid, vec3(1.5f)).fluence.x, 0);
}

TEST(Fluence, AboveALitFloorIsTwiceItsLightAndGoesUp) {
    // A floor of base color ρ under a sun of E: radiance ρE/π from half of all directions, φ = 2ρE, F = ρE upwards.
    Scene scene;
    scene.materials = {lambert(vec3(0.5f, 0.25f, 1))};
    add_mesh(scene, floor_of(0, 4, 0));
    const Box box{vec3(-0.5f, 0, -0.5f), vec3(0.5f, 0.25f, 0.5f)};
    Snapshot snapshot = snapshot_of({homogeneous_medium(1e-5f, box)}, {sun_light({0, -1, 0}, 3)});
    add_surfaces(scene, snapshot);
    const FluenceGrid grid = make_fluence(snapshot, grid_settings(2, 4, 400'000));
    const FluenceAt at = fluence_at(grid, vec3(0, 0.125f, 0));
    for (int c = 0; c < 3; ++c) {
        const float lit = 3 * scene.materials[0].base_color[c];
        EXPECT_NEAR(at.fluence[c], 2 * lit,
                    0.12f * lit); // 3 % of the floor's half of all directions are beyond its rim
        EXPECT_NEAR(at.flux[c].y, lit, 0.06f * lit);
        EXPECT_NEAR(at.flux[c].x, 0, 0.06f * lit);
    }
    // The upper side is dark when light does not pass: a roof over it.
    add_mesh(scene, floor_of(10, 80, 0));
    add_surfaces(scene, snapshot);
    const FluenceGrid dark = make_fluence(snapshot, grid_settings(2, 4, 20'000));
    EXPECT_EQ(fluence_at(dark, vec3(0, 0.125f, 0)).fluence.x, 0);
}

TEST(Fluence, ScattersALobeIntoAWiderLobe) {
    // Light with a Henyey–Greenstein lobe of mean cosine k becomes one of k·g (their moments multiply); by quadrature
    // over the sphere.
    const float k = 0.6f, g = 0.5f;
    FluenceAt at;
    at.fluence = vec3(2, 1, 0);
    const vec3 axis = glm::normalize(vec3(1, 2, -0.5f));
    at.flux[0] = axis * (k * 2), at.flux[1] = vec3(0);
    vec3 x, y;
    make_frame(axis, x, y);
    for (const vec3 eye_ray : {axis, -axis, x, glm::normalize(x + axis)}) {
        const auto over_cosine = [&](double c) {
            const double s = std::sqrt(1 - c * c);
            const auto around = [&](double a) {
                const vec3 travel = static_cast<float>(c) * axis +
                                    static_cast<float>(s) * (std::cos(float(a)) * x + std::sin(float(a)) * y);
                return phase_value_of<double>(forward_phase(k), c) *
                       phase_value_of<double>(forward_phase(g), glm::dot(travel, -eye_ray));
            };
            return integral(around, 0, 2 * std::numbers::pi, 20);
        };
        const vec3 got = scattered_fluence(at, eye_ray, forward_phase(g));
        EXPECT_NEAR(got.x, 2 * integral(over_cosine, -1, 1, 60), 2e-5 * got.x);
        EXPECT_NEAR(got.y, 1 / (4 * pi), 1e-7f);
        EXPECT_EQ(got.z, 0);
    }
    EXPECT_EQ(mean_cosine({PhaseKind::rayleigh, 0.5f}), 0);
}

TEST(Fluence, OfALampIsItsPowerInTheFog) {
    // Light that fog scatters once: 4π I σ ∫ dV / (4π r²) about a lamp in the middle of a thin cube.
    constexpr float sigma = 0.02f;
    const Snapshot snapshot = snapshot_of({homogeneous_medium(sigma, unit_box)}, {point_light(vec3(0.5f), 2)});
    const LightPathRules rules{light_reach(snapshot), unit_box, 2, 5};
    LightPathResult result;
    trace_light_paths(snapshot, even_strata(snapshot, rules.reach, 4), rules, 0, 200'000, 200'000, result);
    const double expected = 4 * std::numbers::pi * 2 * sigma * mean_inverse_square();
    EXPECT_NEAR(result.scattered_once, expected, 0.06 * expected); // 4 standard errors of 2100 collisions in 200000
}

TEST(Fluence, OfALampFarFromTheFogIsWhatArrivesThere) {
    // From 20 m away the cube is lit like by a sun of I / r²; through a spot's beam too.
    constexpr float sigma = 0.05f;
    Light lamp = point_light(vec3(0.5f, 0.5f, 20.5f), 400);
    Light spot = lamp;
    spot.kind = LightKind::spot, spot.direction = vec3(0, 0, -1), spot.inner_cone = 0.1f, spot.outer_cone = 0.2f;
    Light beyond = lamp;
    beyond.range = 20;
    for (const Light& light : {lamp, spot, beyond}) {
        const Snapshot snapshot = snapshot_of({homogeneous_medium(sigma, unit_box)}, {light});
        const LightPathRules rules{light_reach(snapshot), unit_box, 2, 5};
        LightPathResult result;
        trace_light_paths(snapshot, even_strata(snapshot, rules.reach, 8), rules, 0, 200'000, 200'000, result);
        // σ ∫ E dV with E = 1 / (1 + (z - 20)/20)² and so on: under 1 % from 1 at the middle.
        const double expected = light.range == 20 ? 0.0 : sigma * (1 - sigma / 2);
        if (expected > 0) {
            EXPECT_NEAR(result.scattered_once, expected, 0.08 * expected);
        } else {
            EXPECT_LT(result.scattered_once, 0.06 * sigma); // the window leaves 1 - (19.5/20)⁴ and less
        }
    }
}

TEST(Fluence, HasTheSameBitsAtAnyThreadCount) {
    Scene scene;
    scene.materials = {lambert(vec3(0.5f))};
    add_mesh(scene, box_of(vec3(0.2f), vec3(0.6f), 0));
    Snapshot snapshot = snapshot_of({homogeneous_medium(3, unit_box, forward_phase(0.6f))},
                                    {sun_light({1, -1, 0.5f}), point_light({2, 2, 2})});
    add_surfaces(scene, snapshot);
    const auto made = [&] { return make_fluence(snapshot, grid_settings(all_orders, 12, 40'000)); };
    const FluenceGrid one = on_threads(1, made), two = on_threads(2, made);
    EXPECT_EQ(one.values, two.values);
    EXPECT_NE(one.values, make_fluence(snapshot, grid_settings(all_orders, 12, 40'000), 1).values) << "another seed";
}

Settings with_orders(Settings settings, int orders) {
    settings.fluence = grid_settings(orders, 24, 30'000);
    return settings;
}

TEST(Fluence, ChangesNoBitOfSingleScattering) {
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(2, unit_box, forward_phase(0.5f))}, {sun_light({1, -1, 0.5f})});
    const std::vector<Ray> rays = lines_through(vec3(0.5f), 0.8f, 64);
    for (const Visibility visibility : {Visibility::rays, Visibility::intervals, Visibility::exact}) {
        Settings settings;
        settings.march.visibility = visibility;
        const std::vector<Scatter> plain = marched(snapshot, settings, rays),
                                   once = marched(snapshot, with_orders(settings, 1), rays);
        for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(plain[i].radiance, once[i].radiance);
    }
}

// Everything that the cube sends out, by path, and by march with the grid, in all ways that march has.
void expect_power_of_path(float g, int lines, double precision) {
    Medium fog = homogeneous_medium(1.5f, unit_box, forward_phase(g));
    fog.optics.albedo = vec3(0.9f);
    Medium grid = medium_of(unit_volume(16, [](vec3) { return 1.0f; }), 1.5f);
    grid.optics = fog.optics;
    const std::vector<Ray> rays = lines_through(vec3(0.5f), 0.87f, lines);
    for (const Medium& medium : {fog, grid}) {
        const Snapshot snapshot = snapshot_of({medium}, {sun_light({0.4f, -1, 0.3f})});
        const std::vector<Scatter> once = path_light(snapshot, rays, 1);
        for (const int orders : {2, all_orders}) {
            const std::vector<double> path = difference(path_light(snapshot, rays, orders), once);
            const double power = mean_of(path).value;
            for (const Visibility visibility : {Visibility::rays, Visibility::intervals, Visibility::exact}) {
                Settings settings = settings_for(Quality::preview);
                settings.march.visibility = visibility;
                const std::vector<double> march = difference(marched(snapshot, with_orders(settings, orders), rays),
                                                             marched(snapshot, with_orders(settings, 1), rays));
                std::vector<double> apart;
                for (size_t i = 0; i < rays.size(); ++i) apart.push_back(march[i] - path[i]);
                const Mean mean = mean_of(apart);
                EXPECT_LT(std::abs(mean.value), 0.05 * power + 3 * mean.error) << mean.value / power;
                EXPECT_LT(mean.error, precision * power);
            }
        }
    }
}

class FluenceOfCube : public testing::TestWithParam<float> {};
TEST_P(FluenceOfCube, AddsThePowerThatPathFinds) { expect_power_of_path(GetParam(), 6000, 0.09); }
TEST_P(FluenceOfCube, NightlyAddsThePowerThatPathFindsPrecisely) { expect_power_of_path(GetParam(), 300'000, 0.015); }
INSTANTIATE_TEST_SUITE_P(Fluence, FluenceOfCube, testing::Values(0.0f, 0.7f));

TEST(Fluence, LooksTheSameInFroxels) {
    // What orders beyond the first add to the picture, in small froxels and in the march.
    const TestScene stage = half_shadowed_fog();
    const View view = view_of({0, 2, 9}, {0, 1.5f, 0});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot);
    Settings settings;
    settings.of<FroxelSettings>().tile = 2, settings.of<FroxelSettings>().depth_slices = 128;
    settings = as_wide(settings, view.size);
    const auto light = [&](const char* mode, int orders) {
        settings.fluence = grid_settings(orders, 24, 150'000);
        return run_mode(mode, view, stage.snapshot, settings, rays);
    };
    const std::vector<Scatter> march_once = light("march", 1), froxel_once = light("froxel", 1);
    std::vector<Scatter> march = light("march", all_orders), froxel = light("froxel", all_orders);
    for (size_t i = 0; i < rays.size(); ++i)
        march[i].radiance -= march_once[i].radiance, froxel[i].radiance -= froxel_once[i].radiance;
    EXPECT_GT(mean_of(march), 0.05 * mean_of(march_once));
    EXPECT_NEAR(mean_of(froxel), mean_of(march), 0.02 * mean_of(march));
    EXPECT_LT(relative_rmse(froxel, march), relative_rmse(froxel_once, march_once));
}

TEST(Fluence, SaysWhatItLeavesOut) {
    const Snapshot snapshot = snapshot_of({homogeneous_medium(4, unit_box)}, {sun_light({0, -1, 0})}, vec3(1));
    for (const char* name : {"march", "froxel"}) {
        const auto said = [&](int orders) {
            return find_mode(name).limitations(View{}, snapshot, with_orders(Settings{}, orders));
        };
        EXPECT_TRUE(has_limitation(said(1), limitation::single_scattering_only)) << name;
        EXPECT_FALSE(has_limitation(said(3), limitation::single_scattering_only)) << name;
        const Limitations three = said(3), all = said(all_orders);
        EXPECT_EQ(std::ranges::find(three, &limitation::orders_left_out, &Limitation::kind)->amounts[0], 3) << name;
        EXPECT_NEAR(std::ranges::find(all, &limitation::cached_fluence, &Limitation::kind)->amounts[0], 1 / 24.0, 1e-6);
        EXPECT_FALSE(has_limitation(all, limitation::orders_left_out)) << name;
        EXPECT_TRUE(has_limitation(all, limitation::unshadowed_ambient)) << name;
    }
}

// --- the example cloud
// ------------------------------------------------------------------------------------------------- The fog light of
// every pixel of a small picture, the mean of some rays through each.
std::vector<vec3> picture(const char* mode, const Snapshot& snapshot, const View& view, const Settings& settings) {
    const ScatterFunction scatter = find_mode(mode).prepare(view, snapshot, settings, nullptr);
    std::vector<vec3> pixels(static_cast<size_t>(view.size.x) * static_cast<size_t>(view.size.y), vec3(0));
    parallel_for(static_cast<int64_t>(pixels.size()), [&](int64_t p) {
        const ivec2 pixel(static_cast<int>(p) % view.size.x, static_cast<int>(p) / view.size.x);
        for (int first = 0; first < view.pixel_samples; first += 16) {
            Ray rays[16];
            uint32_t ids[16];
            Scatter results[16];
            for (int i = 0; i < 16; ++i) {
                const uint32_t sample = static_cast<uint32_t>(first + i);
                const Sample2 u = sample2(sample, hash(static_cast<uint32_t>(p), view.seed, 3u));
                rays[i] = camera_ray(view.camera, view.size, vec2(pixel) + vec2(u.x, u.y));
                ids[i] = hash(static_cast<uint32_t>(p), sample, view.seed);
            }
            scatter({.rays = rays, .ids = ids}, results);
            for (const Scatter& result : results)
                pixels[static_cast<size_t>(p)] += result.radiance / static_cast<float>(view.pixel_samples);
        }
    });
    return pixels;
}

TEST(FluenceOfCloud, NightlyIsWithinFivePerCentOfPathAndTenTimesAsFast) {
    const Scene scene = load_scene(std::string(TYNDALL_SOURCE_DIR) + "/scenes/cloud.json");
    Snapshot snapshot = make_snapshot(scene, moment_of(scene, 1));
    snapshot.ambient = vec3(0); // the march does not shadow it
    View view;
    view.camera = camera_at(scene, scene.camera, 0);
    view.size = {80, 45}, view.pixel_samples = 16;
    Settings settings = settings_for(Quality::final);
    settings.fluence.orders = all_orders;
    const double start = steady_seconds();
    const std::vector<vec3> march = picture("march", snapshot, view, settings);
    const double march_seconds = steady_seconds() - start;
    view.pixel_samples = 1024;
    const std::vector<vec3> first = picture("path", snapshot, view, settings);
    const double path_seconds = steady_seconds() - start - march_seconds;
    view.seed = 1;
    const std::vector<vec3> second = picture("path", snapshot, view, settings);

    // Squared errors of march, against two independent truths, and of one of these.
    double mean = 0;
    std::vector<double> of_march, of_path;
    for (size_t i = 0; i < march.size(); ++i) {
        mean += glm::dot(first[i] + second[i], vec3(1)) / (6.0 * static_cast<double>(march.size()));
        of_march.push_back(glm::dot(march[i] - first[i], march[i] - second[i]) / 3);
        of_path.push_back(glm::dot(first[i] - second[i], first[i] - second[i]) / 6);
    }
    const Mean march_error = mean_of(of_march), path_error = mean_of(of_path);
    const double square = mean * mean, shown = std::sqrt(std::max(march_error.value, 0.0)) / mean;
    const double path_needs = path_seconds * path_error.value / std::max(march_error.value, 1e-12);
    std::printf("rmse_rel %.4f in %.1f s; path would need %.0f s\n", shown, march_seconds, path_needs);
    EXPECT_LT(march_error.value, 0.05 * 0.05 * square + 2 * march_error.error);
    EXPECT_LT(march_error.error, 0.04 * 0.04 * square) << "too noisy to tell";
    EXPECT_GT(path_needs, 10 * march_seconds);
}
}
}

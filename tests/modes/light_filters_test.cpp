// IES profiles and gobos in every technique: closed forms, and techniques against each other.
#include "modes/light_filters.h"
#include "modes/mode.h"
#include "modes/path/path_rays.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/ies_file.h"
#include "scene/photometry/ies_profile.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/surface.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box room{vec3(-3, -3, -3), vec3(3, 3, 3)};

std::shared_ptr<const IesProfile> profile_of(const std::string& numbers) {
    return make_ies_profile(read_ies("TILT=NONE\n" + numbers, "test.ies"), "test");
}
std::shared_ptr<const IesProfile> lobe() { return lobe_profile(1); }

std::shared_ptr<const Gobo> checkerboard(int side, int blocks, bool colors) {
    return board_gobo(blocks, side / blocks, colors ? vec3(1, 0.47f, 0.12f) : vec3(1), vec3(20.0f / 255));
}

Light projector(std::shared_ptr<const Gobo> gobo, std::shared_ptr<const IesProfile> profile = nullptr) {
    const Light light = spot_light({-1.5f, 1.8f, 0.2f}, {0.8f, -0.7f, -0.1f}, 20, 0.35f, 0.4f);
    return filtered_light(light, std::move(profile), std::move(gobo));
}

const View picture = view_of({0, 0.2f, 2.9f}, vec3(0), {32, 24});

std::vector<Scatter> seen_by(std::string_view mode, const Snapshot& snapshot, Settings settings = {}) {
    return run_mode(mode, picture, snapshot, settings, pixel_rays(picture, snapshot));
}
std::vector<Scatter> truth(const Snapshot& snapshot) { return seen_by("march", snapshot, exact_settings()); }

Light lamp_with(std::shared_ptr<const IesProfile> profile) {
    Light light = point_light({-0.4f, 0.7f, 0.1f}, 10);
    light.direction = glm::normalize(vec3(0.3f, -1, 0.2f));
    return profile ? filtered_light(light, std::move(profile), nullptr) : light;
}

TEST(LightFilters, AConstantProfileIsAPointLight) {
    const auto constant = profile_of("1 -1 1 3 5 1 2 0 0 0\n1 1 0\n0 90 180\n0 90 180 270 360\n"
                                     "7 7 7\n7 7 7\n7 7 7\n7 7 7\n7 7 7\n");
    const std::vector<Medium> fog{homogeneous_medium(0.3f, room, forward_phase(0.4f))};
    const Snapshot plain = snapshot_of(fog, {lamp_with(nullptr)}), filtered = snapshot_of(fog, {lamp_with(constant)});
    for (const Mode& mode : modes()) {
        if (mode.accuracy == Accuracy::artistic || mode.name == "path") continue;
        const std::vector<Scatter> a = seen_by(mode.name, plain), b = seen_by(mode.name, filtered);
        EXPECT_LT(relative_rmse(b, a), mode.name == "froxel" || mode.name == "cone" ? 3e-3 : 2e-4) << mode.name;
    }
    EXPECT_LT(relative_rmse(truth(filtered), truth(plain)), 1e-5);
}

TEST(LightFilters, ACosineLobeLightsSurfacesAsItsIntegralSays) {
    // On a floor h below, at the angle θ: cos θ (lobe) · cos θ (floor) / (h / cos θ)² = cos⁴ θ / h² candela.
    Light light = point_light({0, 2, 0}, 100);
    light.direction = {0, -1, 0};
    light = filtered_light(light, lobe(), nullptr);
    for (const float x : {0.0f, 0.7f, 2.0f, 6.0f}) {
        const LightSample at = arrival(light, {x, 0, 0.5f});
        const double square = x * x + 0.25 + 4, cosine = 2 / std::sqrt(square);
        EXPECT_NEAR(at.irradiance.y * at.to_light.y / (25 * std::pow(cosine, 4)), 1, 1e-4) << x;
    }
    EXPECT_EQ(arrival(light, {0, 3, 0}).irradiance, vec3(0));
}

TEST(LightFilters, FogUnderACosineLobeIsItsQuadrature) {
    // Isotropic fog so thin that it dims nothing: I cos θ / (4π r²) along the ray.
    Light light = point_light({0, 1, 0}, 10);
    light.direction = {0, -1, 0};
    light = filtered_light(light, lobe(), nullptr);
    const Ray ray{{-2, 0.2f, 0.4f}, {1, 0, 0}, 4};
    double expected = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const dvec3 off(-2 + 4 * (i + 0.5) / n, -0.8, 0.4);
        expected += 0.8 / std::pow(glm::length(off), 3) * 4 / n;
    }
    const double scale = 10 * 1e-4 / (4 * double{pi});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(1e-4f, room, {PhaseKind::isotropic, 0})}, {light});
    for (const Settings& settings : {exact_settings(), sliced_settings(), Settings{}})
        EXPECT_NEAR(marched(snapshot, settings, ray).radiance.x / (scale * expected), 1, 2e-3);
}

TEST(LightFilters, MarchFindsALaserInFog) {
    // A beam of 0.03 degrees, in steps of 0.02 of a table that reaches 0.4, crossed at a right angle.
    std::string angles, values;
    for (int i = 0; i <= 20; ++i)
        angles += std::to_string(0.02 * i) + " ", values += std::to_string(std::exp(-0.2222 * i * i)) + " ";
    const auto profile = profile_of("1 -1 1 22 1 1 2 0 0 0\n1 1 0\n" + angles + " 90\n0\n" + values + " 0\n");
    Light light = point_light({0, 1, 0}, 1e4f);
    light.kind = LightKind::spot, light.direction = {0, -1, 0};
    light.inner_cone = light.outer_cone = profile->reach;
    light = filtered_light(light, profile, nullptr);
    const Ray ray{{-0.5f, 0, 0}, {1, 0, 0}, 1};
    double expected = 0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
        const dvec3 off(0.02 * ((i + 0.5) / n - 0.5), -1, 0);
        expected += profile_factor(*profile, {off.x, 0, 1}) / glm::dot(off, off) * 0.02 / n;
    }
    const double scale = 1e4 * 1e-4 / (4 * double{pi});
    const Snapshot snapshot = snapshot_of({homogeneous_medium(1e-4f, room, {PhaseKind::isotropic, 0})}, {light});
    for (const Settings& settings : {exact_settings(), sliced_settings(), Settings{}})
        EXPECT_NEAR(marched(snapshot, settings, ray).radiance.x / (scale * expected), 1, 0.01);
}

TEST(LightFilters, EveryTechniqueFollowsABroadGobo) {
    const std::vector<Medium> fog{homogeneous_medium(0.25f, room, forward_phase(0.3f))};
    for (const bool colors : {false, true}) {
        const Snapshot snapshot = snapshot_of(fog, {projector(checkerboard(16, 4, colors), lobe())});
        const std::vector<Scatter> exact = truth(snapshot);
        const std::pair<const char*, double> bounds[] = {
            {"march", 0.03}, {"shadow-volume", 0.03}, {"shadow-map", 0.06}, {"froxel", 0.05}, {"cone", 0.03}};
        for (const auto& [mode, bound] : bounds) {
            const std::vector<Scatter> got = seen_by(mode, snapshot);
            EXPECT_LT(relative_rmse(got, exact), bound) << mode << (colors ? " in colors" : "");
            EXPECT_NEAR(mean_of(got) / mean_of(exact), 1, 0.02) << mode;
        }
        if (colors) {
            vec3 sum(0);
            for (const Scatter& one : exact) sum += one.radiance;
            EXPECT_GT(sum.x, 1.5f * sum.z);
        }
    }
}

TEST(LightFilters, PathsAgreeWithTheMarch) {
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(0.25f, room)}, {projector(checkerboard(64, 8, true), lobe())});
    const Ray ray{{0.1f, 0.1f, 2.9f}, glm::normalize(vec3(0.1f, -0.2f, -1)), 6};
    const RayEstimate path = traced(snapshot, ray, 2048, 1);
    const Scatter march = marched(snapshot, exact_settings(), ray);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(path.value[c], double{march.radiance[c]}, 4.5 * path.error[c]) << c;
    EXPECT_LT(path.error[0], 0.05 * path.value[0]);
}

TEST(LightFilters, GridFogIsLitThroughThem) {
    const Medium grid =
        medium_of(unit_volume(16, [](vec3 p) { return 0.5f + 0.5f * std::sin(9 * p.x) * std::sin(7 * p.y); }), 1);
    Light light = projector(checkerboard(16, 4, true));
    light.position = {-1, 1.6f, 0.5f}, light.direction = glm::normalize(vec3(0.5f) - light.position);
    light = filtered_light(light, nullptr, light.filter->gobo);
    const Snapshot snapshot = snapshot_of({grid}, {light});
    const View view = view_of({0.5f, 0.6f, 3}, vec3(0.5f), {32, 24}, 0.5f);
    const std::vector<Ray> rays = pixel_rays(view, snapshot);
    const std::vector<Scatter> exact = run_mode("march", view, snapshot, exact_settings(), rays);
    for (const auto& [mode, bound] : {std::pair{"march", 0.06}, {"shadow-map", 0.1}, {"froxel", 0.12}})
        EXPECT_LT(relative_rmse(run_mode(mode, view, snapshot, {}, rays), exact), bound) << mode;
}

TEST(LightFilters, TechniquesSayWhatTheyCannotShow) {
    const Snapshot fine = snapshot_of({homogeneous_medium(0.25f, room)}, {projector(checkerboard(120, 60, false))});
    const auto of = [&](std::string_view mode, const Snapshot& snapshot) {
        return find_mode(mode).limitations(picture, snapshot, {});
    };
    for (const char* mode : {"march", "shadow-volume", "shadow-map"})
        EXPECT_TRUE(has_limitation(of(mode, fine), limitation::sampled_gobo)) << mode;
    for (const char* mode : {"froxel", "cone"})
        EXPECT_TRUE(has_limitation(of(mode, fine), limitation::blurred_filter)) << mode;
    for (const char* mode : {"billboard", "radial-blur"})
        EXPECT_TRUE(has_limitation(of(mode, fine), limitation::mean_filter)) << mode;
    EXPECT_FALSE(has_limitation(of("froxel", fine), limitation::sampled_gobo));
    const Snapshot broad = snapshot_of({homogeneous_medium(0.25f, room)}, {projector(checkerboard(8, 2, false))});
    EXPECT_FALSE(has_limitation(of("march", broad), limitation::sampled_gobo));
    EXPECT_FALSE(has_limitation(of("froxel", broad), limitation::blurred_filter));
    // Half of the board is white, half is 20 / 255: its spread over its mean.
    const Snapshot board = snapshot_of({homogeneous_medium(0.25f, room)}, {projector(checkerboard(96, 4, false))});
    for (const Limitation& one : of("billboard", board)) {
        if (one.is(limitation::mean_filter)) {
            EXPECT_NEAR(one.amounts[0], (1 - 20.0 / 255) / (1 + 20.0 / 255), 0.05);
        }
    }
}
}
}

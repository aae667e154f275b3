// Light and colors from grids: closed forms for each convention, and modes against each other.
#include "integrate/lights/field_light.h"
#include "modes/fire_scenes.h"
#include "modes/mode.h"
#include "modes/path/path_rays.h"
#include "modes/path/tracer.h"
#include "support/run_mode.h"
#include "trace/lights/emissive_bricks.h"
#include "trace/small_scenes.h"
#include "volume/emission/blackbody.h"
#include "volume/emission/emission_field.h"
#include "volume/medium.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr float hot = 1500;    // kelvin; halves hold it
constexpr double sigmas = 4.5; // a false alarm once in 150000 comparisons

SparseVolume even(float value) {
    return tenth_volume(ivec3(40), [=](ivec3) { return value; });
}

// A plume: hotter in the middle and below, cold outside.
float plume(ivec3 voxel) {
    const vec3 at = (vec3(voxel) - vec3(20, 0, 20)) / vec3(8, 24, 8);
    return 2200 * std::pow(std::max(0.0f, 1 - glm::dot(at, at)), 0.15f);
}

// From inside the box to inside the box: no edge is met.
const Ray inside{{1, 1.2f, 0.4f}, {0, 0, 1}, 3};

MediumSource glowing(const TempFolder& scratch, BlackbodyKind kind, float extinction, vec3 albedo = vec3(0)) {
    MediumSource source = grid_source(scratch, "fire", even(1), extinction, albedo);
    source.temperature = property(scratch, "temperature", even(hot));
    source.blackbody = BlackbodySource{.kind = kind, .scale = 0.25f, .tint = vec3(1, 0.5f, 1)};
    source.blackbody->by_absorption = kind == BlackbodyKind::pbrt;
    return source;
}

TEST(GridEmission, BoxInVacuumIsEmissionTimesLength) {
    const TempFolder scratch;
    for (const BlackbodyKind kind : {BlackbodyKind::kelvin, BlackbodyKind::cycles}) {
        Scene scene;
        const Snapshot snapshot = snapshot_with(scene, glowing(scratch, kind, 0));
        ASSERT_EQ(snapshot.media.size(), 1u);
        const dvec3 expected = 0.25 * 3 * dvec3(1, 0.5, 1) * blackbody_color(kind, hot);
        expect_along(snapshot, inside, expected, std::string(blackbody_names[static_cast<size_t>(kind)]));
    }
}

// What it gives off alone.
Snapshot without_scattering(Snapshot snapshot) {
    for (Medium& medium : snapshot.media) medium.optics.albedo = vec3(0);
    return snapshot;
}

// What emits as it absorbs: j/σ (1 - e^-τ) with j = B σ (1 - albedo).
TEST(GridEmission, AbsorbingBoxIsItsClosedForm) {
    const TempFolder scratch;
    const double extinction = 0.75, dimmed = 1 - std::exp(-3 * extinction);
    for (const BlackbodyKind kind : {BlackbodyKind::kelvin, BlackbodyKind::cycles, BlackbodyKind::pbrt}) {
        Scene scene;
        const MediumSource source = glowing(scratch, kind, static_cast<float>(extinction), {0.25f, 0.5f, 0.75f});
        const dvec3 light = 0.25 * dvec3(1, 0.5, 1) * blackbody_color(kind, hot);
        const dvec3 absorbed = kind == BlackbodyKind::pbrt ? dvec3(0.75, 0.5, 0.25) : dvec3(1 / extinction);
        expect_along(without_scattering(snapshot_with(scene, source)), inside, light * absorbed * dimmed,
                     std::string(blackbody_names[static_cast<size_t>(kind)]));
    }
    Scene scene;
    MediumSource source = glowing(scratch, BlackbodyKind::kelvin, static_cast<float>(extinction), vec3(0.5f));
    source.blackbody->by_absorption = true;
    const dvec3 light = 0.25 * dvec3(1, 0.5, 1) * blackbody_color(BlackbodyKind::kelvin, hot);
    expect_along(without_scattering(snapshot_with(scene, source)), inside, light * 0.5 * dimmed,
                 "kelvin as it absorbs");
}

TEST(GridEmission, StyleDensityBrightensOnlyWhatAbsorbs) {
    const TempFolder scratch;
    for (const BlackbodyKind kind : {BlackbodyKind::kelvin, BlackbodyKind::pbrt})
        for (const float density : {0.0f, 3.0f}) {
            Scene scene;
            Settings settings;
            const Snapshot plain = without_scattering(snapshot_with(scene, glowing(scratch, kind, 1e-4f)));
            const float once = marched(plain, settings, inside).radiance.x;
            settings.style.density = density;
            const float factor = kind == BlackbodyKind::pbrt ? density : 1;
            EXPECT_NEAR(marched(plain, settings, inside).radiance.x / once, factor, 1e-3f); // 3e-4 optical depths
        }
}

// Nearly all places on a line through thick smoke are hidden in it: picked there alone, this would be 1.5 of noise.
TEST(GridEmission, InThickSmokePathsSeeWhatTheyCollideWith) {
    const TempFolder scratch;
    constexpr double extinction = 100;
    Scene scene;
    const Snapshot snapshot =
        snapshot_with(scene, glowing(scratch, BlackbodyKind::kelvin, static_cast<float>(extinction)));
    const dvec3 expected = 0.25 * dvec3(1, 0.5, 1) * blackbody_color(BlackbodyKind::kelvin, hot) / extinction;
    const RayEstimate traced = test::traced(snapshot, inside, 64, 0);
    EXPECT_NEAR(traced.value.x, expected.x, sigmas * traced.error.x);
    EXPECT_LT(traced.error.x, 0.1 * expected.x);
}

// A whole ray meets the edges, where the temperature falls to 0 within a voxel.
TEST(GridEmission, SteepEdgesAreResolved) {
    const TempFolder scratch;
    Scene scene;
    const Snapshot snapshot = snapshot_with(scene, glowing(scratch, BlackbodyKind::kelvin, 0));
    const Ray through{{1, 1.2f, -2}, {0, 0, 1}, 10};
    dvec3 edge(0);
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i)
        edge += blackbody_color(BlackbodyKind::kelvin, hot * (i + 0.5) / steps) * (0.1 / steps);
    const dvec3 expected = 0.25 * dvec3(1, 0.5, 1) * (blackbody_color(BlackbodyKind::kelvin, hot) * 3.9 + 2.0 * edge);
    expect_light(marched(snapshot, settings_for(Quality::preview), through).radiance, expected, 1e-3, "march");
    const RayEstimate traced = test::traced(snapshot, through, 256, 0);
    EXPECT_NEAR(traced.value.x, expected.x, sigmas * traced.error.x + 1e-3 * expected.x);
}

MediumSource fire(const TempFolder& scratch, float extinction, vec3 albedo) {
    MediumSource source = grid_source(
        scratch, "fire", tenth_volume(ivec3(40), [](ivec3 at) { return at.y < 30 ? 0.5f : 1.0f; }), extinction, albedo);
    source.temperature = property(scratch, "temperature", tenth_volume(ivec3(40), plume));
    source.flame =
        property(scratch, "flame", tenth_volume(ivec3(40), [](ivec3 at) { return at.y < 20 ? 1.0f : 0.5f; }));
    source.blackbody = BlackbodySource{.scale = 0.5f};
    return source;
}

// Of a fire in smoke that does not scatter, every mode that follows fields agrees on every ray.
TEST(GridEmission, MarchAgreesWithPathOnAFire) {
    const TempFolder scratch;
    Scene scene;
    const Snapshot snapshot = snapshot_with(scene, fire(scratch, 0.8f, vec3(0)));
    const View view = view_of({6, 3, 7}, {2, 1, 2}, {64, 36});
    const std::vector<Ray> rays = pixel_rays(view, snapshot, 100);
    const auto exact = run_mode("march", view, snapshot, exact_settings(), rays);
    for (const char* mode : {"march", "froxel", "shadow-map", "shadow-volume"}) {
        const auto found = run_mode(mode, view, snapshot, settings_for(Quality::preview), rays);
        EXPECT_LT(relative_rmse(found, exact), 0.01) << mode;
    }
    const auto cone = run_mode("cone", view, snapshot, settings_for(Quality::preview), rays);
    EXPECT_NEAR(mean_of(cone), mean_of(exact), 0.15 * mean_of(exact)) << "its mean color, evenly spread";
    for (size_t i = 0; i < rays.size(); i += 211) {
        const RayEstimate traced = test::traced(snapshot, rays[i], 64, 0);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(traced.value[c], exact[i].radiance[c],
                        sigmas * traced.error[c] + 5e-3 * exact[i].radiance.x + 1)
                << i;
    }
}

// The light of a plume that a smoke beside it scatters: aimed at, or met by chance, it is the same.
TEST(GridEmission, LayersAddUpAndEmissionIsApart) {
    const TempFolder scratch;
    Scene scene;
    const Snapshot snapshot = snapshot_with(scene, fire(scratch, 0.8f, vec3(0.5f)));
    const View view = view_of({6, 3, 7}, {2, 1, 2}, {16, 9});
    const std::vector<Ray> rays = pixel_rays(view, snapshot, 100);
    for (const char* mode : {"march", "froxel", "shadow-map", "shadow-volume"}) {
        std::vector<vec3> parts;
        const auto whole = run_mode(mode, view, snapshot, settings_for(Quality::preview), rays);
        run_mode(mode, view, snapshot, settings_for(Quality::preview), rays, &parts);
        const size_t count = part_count(0);
        for (size_t i = 0; i < rays.size(); ++i)
            expect_light(parts[i * count + static_cast<size_t>(OtherLight::emission)], dvec3(whole[i].radiance), 1e-4,
                         mode);
    }
}

// A grid of numbers times a color, and a grid of colors, both free of the density.
TEST(GridEmission, RadianceOfGrids) {
    const TempFolder scratch;
    MediumSource source = grid_source(scratch, "glow", even(1), 0.5f);
    source.emission_grid = property(scratch, "emission", even(4));
    source.emission = vec3(1, 2, 3);
    Scene scene;
    const double through = (1 - std::exp(-1.5)) / 0.5;
    expect_along(snapshot_with(scene, source), inside, 4.0 * through * dvec3(1, 2, 3), "numbers");
    source.extinction = 0.0f;
    expect_along(snapshot_with(scene, source), inside, 4.0 * 3.0 * dvec3(1, 2, 3), "in vacuum");
}

// Sunlit fog that is white on one side and blue-green on the other.
TEST(GridColor, EveryModeThatLooksPointByPointAgrees) {
    const TempFolder scratch;
    MediumSource source = grid_source(scratch, "smoke", even(1), 0.5f, vec3(0.9f, 0.8f, 0.7f));
    source.albedo_grid =
        property(scratch, "Cd", tenth_volume(ivec3(40), [](ivec3 at) { return at.z < 20 ? 0.25f : 1; }));
    Scene scene;
    Snapshot snapshot = snapshot_with(scene, source);
    snapshot.ambient = vec3(0.3f);
    EXPECT_NEAR(snapshot.media[0].optics.albedo.x, 0.9f * 0.625f, 2e-3);
    snapshot.lights = {sun_light({0, -1, 0}, 2)};
    const auto exact = marched(snapshot, exact_settings(), inside);
    // Half of the way in either color: along z the sun is dimmed evenly, as it falls along y.
    const double depth = 0.5 * (3.95 - 1.2), phase = 1 / (4 * double(pi));
    const double early = 1 - std::exp(-0.5 * 1.55), late = std::exp(-0.5 * 1.55) - std::exp(-1.5);
    const double source_light = 2 * phase * std::exp(-depth) + 0.3;
    const double expected = 0.9 * source_light * (0.25 * early + late);
    EXPECT_NEAR(exact.radiance.x, expected, 0.01 * expected);
    EXPECT_NEAR(exact.radiance.y / exact.radiance.x, 0.8 / 0.9, 1e-3);
    const auto quick = marched(snapshot, settings_for(Quality::final), inside);
    EXPECT_NEAR(quick.radiance.x, exact.radiance.x, 0.01 * exact.radiance.x);
    snapshot.ambient = vec3(0); // path shadows it
    const double scattered = marched(snapshot, exact_settings(), inside).radiance.x;
    const RayEstimate traced = test::traced(snapshot, inside, 256, 1);
    EXPECT_NEAR(traced.value.x, scattered, sigmas * traced.error.x);
    EXPECT_LT(traced.error.x, 0.01 * scattered);
}

// Seen from afar, a flame is a lamp of as many candela as it emits: ∫ j dV.
TEST(GridEmission, AFlameLightsSmokeAsALampDoes) {
    const TempFolder scratch;
    MediumSource source = grid_source(scratch, "flame", even(0), 0);
    SparseVolume flame = tenth_volume(ivec3(8), [](ivec3) { return hot; });
    flame.index_to_world = glm::scale(dmat4(1), dvec3(0.01));
    source.temperature = property(scratch, "temperature", flame);
    source.blackbody = BlackbodySource{};
    source.translation = vec3(-2, 1, 1);
    Scene scene;
    Snapshot snapshot = snapshot_with(scene, source);
    ASSERT_EQ(snapshot.media.size(), 1u);
    const Medium fire = snapshot.media[0];
    dvec3 candela(0);
    constexpr int steps = 96; // across 9 voxels
    for (int i = 0; i < steps * steps * steps; ++i) {
        const vec3 share = (vec3(i % steps, i / steps % steps, i / steps / steps) + 0.5f) / float(steps);
        candela += dvec3(emission_at(fire, vec3(-2, 1, 1) + 0.09f * share - 0.01f)) * std::pow(0.09 / steps, 3);
    }
    const Medium smoke = homogeneous_medium(0.4f, {vec3(0), vec3(2)}, forward_phase(0.3f), vec3(0.8f));
    snapshot.media = {smoke, fire};
    const Ray ray{{1, 1, -1}, {0, 0, 1}, 10};

    Light lamp = point_light(vec3(-2, 1, 1) + 0.035f);
    lamp.intensity = vec3(candela);
    const vec3 expected = marched(snapshot_of({smoke}, {lamp}), exact_settings(), ray).radiance;
    const auto of_march = [&](const Settings& settings) {
        return estimate_ray(find_mode("march").prepare(View{}, snapshot, settings, nullptr), ray, 256, fog_light);
    };
    for (const RayEstimate& found : {test::traced(snapshot, ray, 256, 1), of_march({}), of_march(exact_settings())})
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(found.value[c], expected[c], sigmas * found.error[c] + 2e-3 * expected.x);
            EXPECT_LT(found.error[c], 0.01 * expected.x);
        }
    const View view = view_of({1, 1, -1}, {1, 1, 0});
    for (const char* mode : {"shadow-map", "shadow-volume", "cone"}) {
        const Scatter found = run_mode(mode, view, snapshot, settings_for(Quality::final), {ray}).front();
        const Scatter own = run_mode(mode, view, snapshot_of({smoke}, {lamp}), settings_for(Quality::final), {ray})[0];
        expect_light(found.radiance, dvec3(own.radiance), 5e-3, mode);
    }
}

// Aimed at or met by chance, light inside and beside a flame is the same: nothing is counted twice.
TEST(GridEmission, AimingAtAFlameChangesNoMean) {
    const TempFolder scratch;
    Scene scene;
    const Snapshot snapshot = snapshot_with(scene, fire(scratch, 3, vec3(0.9f)));
    for (const Ray& ray : {Ray{{2, 0.6f, -2}, {0, 0, 1}, 20}, Ray{{-2, 3.2f, 2}, {1, 0, 0}, 20}}) {
        auto unaimed = std::make_shared<PathTracer>();
        unaimed->snapshot = snapshot, unaimed->has_emission = true;
        EmissiveBricks dark; // aims at a corner without light
        dark.fields = take_fields(unaimed->snapshot, {}, {}).fields;
        dark.bricks = {{0, 0}}, dark.cumulative = {1};
        for (const Medium& field : dark.fields)
            dark.sampling.push_back({field.density.bricks, std::vector<float>(1 << 20), 1});
        unaimed->fire = std::make_shared<const EmissiveBricks>(std::move(dark));
        const RayEstimate by_chance = estimate_ray(
            [unaimed](const RayBatch& batch, std::span<Scatter> results) { trace_paths(*unaimed, batch, results); },
            ray, 512, [](const Scatter& s) { return s.radiance; });
        const RayEstimate aimed = traced(snapshot, ray, 512);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(aimed.value[c], by_chance.value[c], sigmas * std::hypot(aimed.error[c], by_chance.error[c]))
                << c;
        EXPECT_LT(aimed.error.x, 1.2 * by_chance.error.x);
    }
}

// Voxels without a color do not darken those beside them.
TEST(GridColor, EdgesOfAColorDoNotDarken) {
    const TempFolder scratch;
    MediumSource source = grid_source(scratch, "smoke", even(1), 0.5f, vec3(0.8f));
    source.albedo_grid = property(scratch, "Cd", tenth_volume(ivec3(40, 40, 20), [](ivec3) { return 0.5f; }));
    Scene scene;
    const Snapshot snapshot = snapshot_with(scene, source);
    const Optics& optics = snapshot.media[0].optics;
    for (const float z : {0.5f, 1.9f, 1.95f, 1.99f}) EXPECT_NEAR(albedo_at(optics, {1, 1, z}).x, 0.4f, 1e-3) << z;
    EXPECT_NEAR(albedo_at(optics, {1, 1, 2.5f}).x, 0.8f, 1e-6);
}
}
}

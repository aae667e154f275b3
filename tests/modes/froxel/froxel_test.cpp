// The froxel cache against closed forms and the exact march.
#include "modes/froxel/froxel_fixtures.h"
#include "support/threads.h"

#include "modes/history.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const double four_pi = 4 * std::acos(-1.0);
const std::vector<std::string> ways{
    "froxel.lookup=trilinear", "froxel.lookup=tricubic", "froxel.lookup=jittered", "froxel.visibility=rays",
    "froxel.shadow_rays=3",    "froxel.depth_growth=1",  "froxel.tile=1"};

Settings with(const std::vector<std::string>& assignments) {
    Settings settings;
    for (const std::string& assignment : assignments) apply_setting(settings, assignment);
    return settings;
}

TEST(Froxel, EvenFogMatchesItsClosedFormAtEveryDepth) {
    // Sun across the view, not dimmed on its way: L = p E (1 - e^-σt), T = e^-σt, also in the middle of slices.
    const float extinction = 0.15f;
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(extinction, {vec3(-60), vec3(60)})}, {sun_light({0, -1, 0}, 2)});
    const View view = view_of({0, 0, 25}, {0, 0, 0});
    for (const std::string& way : ways) {
        const ScatterFunction scatter = froxels(view, snapshot, with({way, "terms.light=off"}));
        for (const vec2 pixel : {vec2(32.5f, 18.5f), vec2(0.5f, 0.5f), vec2(63.9f, 20), vec2(12.3f, 35.9f)})
            for (float t = 0.05f; t < 50; t *= 1.07f) {
                Ray ray = camera_ray(view.camera, view.size, pixel);
                ray.t_max = t;
                const Scatter result = scattered(scatter, {ray})[0];
                const double covered = -std::expm1(-double(extinction) * t);
                EXPECT_NEAR(result.radiance.x / (2 / four_pi * covered), 1, 5e-3) << way << " at " << t;
                EXPECT_NEAR(result.transmittance / std::exp(-double(extinction) * t), 1, 1e-4) << way << " at " << t;
            }
    }
}

TEST(Froxel, AmbientLightAndEmissionMatchTheirClosedForms) {
    // L = (albedo · ambient + j/σ) (1 - e^-σs) through a box of depth s = 4 seen from outside, straight on.
    Snapshot snapshot =
        snapshot_of({homogeneous_medium(0.5f, {vec3(-50, -50, -4), vec3(50, 50, 0)})}, {}, vec3(0.5f, 1, 2));
    snapshot.media[0].optics.albedo = vec3(0.9f, 0.6f, 0.3f),
    snapshot.media[0].optics.emission.radiance = vec3(1, 0, 2);
    const View view = view_of({0, 0, 6}, {0, 0, 0}, {65, 37});
    const Scatter result = scattered(froxels(view, snapshot, {}), {{{0, 0, 6}, {0, 0, -1}, 100}})[0];
    const double covered = -std::expm1(-2.0);
    EXPECT_NEAR(result.transmittance, std::exp(-2.0), 1e-5);
    EXPECT_NEAR(result.radiance.x / ((0.9 * 0.5 + 2) * covered), 1, 1e-4);
    EXPECT_NEAR(result.radiance.y / (0.6 * covered), 1, 1e-4);
    EXPECT_NEAR(result.radiance.z / ((0.3 * 2 + 4) * covered), 1, 1e-4);
}

TEST(Froxel, FogWithoutEndIsFollowedBehindTheScene) {
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.02f)}, {sun_light({0, -1, 0}, 2)});
    const View view = view_of({0, 0, 12}, {0, 0, 0});
    const ScatterFunction scatter = froxels(view, snapshot, with({"terms.light=off"}));
    for (const float t : {5.0f, 20.0f, 24.0f, 60.0f, 300.0f, 600.0f}) {
        Ray ray = camera_ray(view.camera, view.size, {20, 10});
        ray.t_max = t;
        const Scatter result = scattered(scatter, {ray})[0];
        EXPECT_NEAR(result.radiance.x / (2 / four_pi * -std::expm1(-0.02 * t)), 1, 5e-3) << t;
        EXPECT_NEAR(result.transmittance, std::exp(-0.02 * t), 1e-4) << t;
    }
}

TEST(Froxel, ADarkRoomStaysDark) {
    // A closed room of thin walls in fog that is everywhere, under a sun of 100 000 lux.
    Mesh room = box_of({-3, 0, -4}, {3, 3, 4});
    const std::vector<Medium> fog{homogeneous_medium(0.1f, {vec3(-20), vec3(20)})};
    const TestScene stage = make_scene(fog, {sun_light({0.4f, -1, 0.3f}, 1e5f)}, {room});
    const View inside = view_of({1.5f, 1.2f, 3.5f}, {-1, 1.4f, -4});
    const View outside = view_of({1.5f, 1.2f, 15}, {-1, 1.4f, 6});
    for (const int tile : {1, 4, 8, 16})
        for (const char* visibility : {"rays", "intervals"}) {
            const Settings settings =
                as_wide(with({"froxel.tile=" + std::to_string(tile), std::string("froxel.visibility=") + visibility}),
                        inside.size);
            const double dark =
                mean_of(scattered(froxels(inside, stage.snapshot, settings), pixel_rays(inside, stage.snapshot)));
            const double bright =
                mean_of(scattered(froxels(outside, stage.snapshot, settings), pixel_rays(outside, stage.snapshot, 30)));
            EXPECT_GT(bright, 0);
            EXPECT_LT(dark, 1e-3 * bright) << tile << visibility;
        }
}

TEST(Froxel, FogHalfInShadowHasTheReferencesEnergy) {
    const TestScene stage = half_shadowed_fog();
    const View view = view_of({0.5f, 1.5f, 9}, {0, 1.5f, 0});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot);
    const std::vector<Scatter> truth = marched(stage.snapshot, exact_settings(), rays);
    for (const char* visibility : {"rays", "intervals"}) {
        const Settings settings =
            as_wide(with({std::string("froxel.visibility=") + visibility, "froxel.tile=2"}), view.size);
        const std::vector<Scatter> results = scattered(froxels(view, stage.snapshot, settings), rays);
        EXPECT_NEAR(mean_of(results) / mean_of(truth), 1, 0.01) << visibility;
    }
    // Finer froxels come closer, down to what is left of the light's path through the fog.
    std::vector<double> errors;
    for (const auto& [tile, slices] : {std::pair{4, 16}, {2, 32}, {1, 64}, {1, 256}})
        errors.push_back(
            relative_rmse(scattered(froxels(view, stage.snapshot,
                                            as_wide(with({"froxel.tile=" + std::to_string(tile),
                                                          "froxel.depth_slices=" + std::to_string(slices)}),
                                                    view.size)),
                                    rays),
                          truth));
    EXPECT_LT(errors[1], errors[0]);
    EXPECT_LT(errors[2], 0.5 * errors[1]);
    EXPECT_LT(errors[3], 5e-3);
}

TEST(Froxel, ALampInsideAFroxelIsAsBrightAsTheReference) {
    // The lamp is as large as a pixel, so that single rays tell how bright pixels are; froxels are half a meter wide.
    const View view = view_of({0, 0, 6}, {0, 0, 0});
    double least[2] = {infinity, infinity}, most[2] = {};
    for (int i = 0; i < 6; ++i) {
        Light lamp = point_light({0.1f * static_cast<float>(i), 0.1f, 0.3f});
        lamp.radius = 0.15f;
        const Snapshot snapshot = snapshot_of({homogeneous_medium(0.2f, {vec3(-3), vec3(3)})}, {lamp});
        const std::vector<Ray> rays = pixel_rays(view, snapshot);
        const double truth = mean_of(marched(snapshot, exact_settings(), rays));
        for (const int exact : {0, 1}) {
            const Settings settings = as_wide(with({"froxel.tile=4", "froxel.depth_slices=32",
                                                    exact ? "froxel.visibility=intervals" : "froxel.visibility=rays"}),
                                              view.size);
            const double ratio = mean_of(scattered(froxels(view, snapshot, settings), rays)) / truth;
            EXPECT_NEAR(ratio, 1, 0.05) << exact << " at " << i;
            least[exact] = std::min(least[exact], ratio), most[exact] = std::max(most[exact], ratio);
        }
    }
    EXPECT_LT(most[0] - least[0], 0.03);
    EXPECT_LT(most[1] - least[1], 0.03);
}

TEST(Froxel, StretchesBehindGlassContinueTheRay) {
    const TestScene stage = make_scene({homogeneous_medium(0.3f, {vec3(-6), vec3(6)})},
                                       {sun_light({0.3f, -1, 0.1f}, 2), point_light({1, 1, -2}, 5)},
                                       {quad({-50, 4, -50}, {50, 0, 0}, {0, 0, 100})});
    const View view = view_of({0, 0, 5}, {0, 0, 0});
    const ScatterFunction scatter = froxels(view, stage.snapshot, {});
    for (const vec2 pixel : {vec2(30, 12), vec2(50, 30), vec2(3, 3)})
        for (const float cut : {0.5f, 2.0f, 5.5f}) {
            Ray whole = camera_ray(view.camera, view.size, pixel), first = whole, second = whole;
            whole.t_max = 9, first.t_max = cut;
            second.origin = whole.at(cut), second.t_max = 9 - cut;
            const auto parts = scattered(scatter, {whole, first, second});
            EXPECT_NEAR(parts[0].transmittance / (parts[1].transmittance * parts[2].transmittance), 1, 1e-4);
            const float sum = parts[1].radiance.x + parts[1].transmittance * parts[2].radiance.x;
            EXPECT_NEAR(sum / parts[0].radiance.x, 1, 1e-3) << cut;
        }
}

TestScene busy_scene() {
    Medium banks = medium_of(unit_volume(16, [](vec3 p) { return p.x * p.y + 0.2f; }), 0.6f);
    Light soft = point_light({1.4f, 1.2f, 0.4f}, 3);
    soft.radius = 0.1f;
    return make_scene({homogeneous_medium(0.2f, {vec3(-1), vec3(2)}), banks}, {sun_light({0.4f, -1, -0.3f}, 1), soft},
                      {box_of({0.3f, 0.2f, 0.2f}, {0.6f, 0.6f, 0.5f}), quad({-9, -1, -9}, {18, 0, 0}, {0, 0, 18})},
                      vec3(0.1f));
}

bool same(const Scatter& a, const Scatter& b) {
    return a.radiance == b.radiance && a.transmittance == b.transmittance && a.validity == b.validity;
}

TEST(Froxel, ARayDoesNotKnowItsNeighborsNorTheThreads) {
    const TestScene stage = busy_scene();
    const View view = view_of({0.5f, 0.8f, 3.5f}, {0.5f, 0.4f, 0.5f});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 8);
    for (const char* visibility : {"rays", "intervals"}) {
        const Settings settings = with({std::string("froxel.visibility=") + visibility});
        const auto seen = [&](size_t packet) {
            return [&, packet] { return scattered(froxels(view, stage.snapshot, settings), rays, packet); };
        };
        const std::vector<Scatter> alone = on_threads(1, seen(1)), packed = on_threads(3, seen(16));
        for (size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same(alone[i], packed[i])) << visibility << i;
    }
}

TEST(Froxel, PositionsAndRaysFindTheSameFroxels) {
    const TestScene stage = busy_scene();
    View view = view_of({0.5f, 0.8f, 3.5f}, {0.5f, 0.4f, 0.5f});
    for (const float ortho : {0.0f, 1.5f}) {
        view.camera.ortho_height = ortho;
        const ScatterFunction scatter = froxels(view, stage.snapshot, {});
        for (const vec2 pixel : {vec2(10, 20), vec2(40.3f, 7.7f), vec2(63, 35)}) {
            Ray ray = camera_ray(view.camera, view.size, pixel);
            ray.t_max = 3.2f;
            Scatter by_position, by_ray;
            const uint32_t id = 0;
            scatter({.rays = {&ray, 1}, .ids = {&id, 1}, .positions = {&pixel, 1}}, {&by_position, 1});
            scatter({.rays = {&ray, 1}, .ids = {&id, 1}}, {&by_ray, 1});
            EXPECT_NEAR(by_ray.radiance.x / by_position.radiance.x, 1, 1e-3);
            EXPECT_NEAR(by_ray.transmittance, by_position.transmittance, 1e-5);
        }
    }
}

TEST(Froxel, OrthographicCamerasAgreeWithTheReference) {
    const TestScene stage = busy_scene();
    View view = view_of({0.5f, 0.8f, 3.5f}, {0.5f, 0.4f, 0.5f});
    view.camera.ortho_height = 1.5f;
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 8);
    const Settings settings =
        as_wide(with({"froxel.tile=2", "froxel.depth_slices=128", "froxel.shadow_rays=4"}), view.size);
    const double truth = mean_of(marched(stage.snapshot, sampled_settings(), rays));
    EXPECT_NEAR(mean_of(scattered(froxels(view, stage.snapshot, settings), rays)) / truth, 1, 0.02);
}

TEST(Froxel, PartsOfTheLightsAddUp) {
    TestScene stage = busy_scene();
    stage.snapshot.ambient = vec3(0);
    const View view = view_of({0.5f, 0.8f, 3.5f}, {0.5f, 0.4f, 0.5f});
    for (const bool with_history : {false, true}) {
        History history;
        if (with_history) froxels(view, stage.snapshot, {}, &history);
        const ScatterFunction scatter = froxels(view, stage.snapshot, {}, with_history ? &history : nullptr);
        for (const Ray& ray : {pixel_rays(view, stage.snapshot, 8)[900], pixel_rays(view, stage.snapshot, 8)[1500]}) {
            Scatter result;
            vec3 parts[part_count(2)]{};
            const uint32_t id = 0;
            scatter({.rays = {&ray, 1}, .ids = {&id, 1}, .parts = parts}, {&result, 1});
            EXPECT_GT(parts[0].x, 0);
            EXPECT_GT(parts[1].x, 0);
            EXPECT_NEAR((parts[0].x + parts[1].x) / result.radiance.x, 1, 1e-5);
        }
    }
}

TEST(Froxel, NoFogIsNothing) {
    const TestScene stage = make_scene({}, {sun_light({0, -1, 0})}, {box_of(vec3(-1), vec3(1))});
    const View view = view_of({0, 0, 6}, vec3(0));
    for (const Scatter& result : scattered(froxels(view, stage.snapshot, {}), pixel_rays(view, stage.snapshot))) {
        EXPECT_EQ(result.radiance, vec3(0));
        EXPECT_EQ(result.transmittance, 1);
    }
}

TEST(Froxel, SurfacesInTheLastFroxelLowerTheValidity) {
    const TestScene stage = busy_scene();
    const View view = view_of({0.5f, 0.8f, 3.5f}, {0.5f, 0.4f, 0.5f});
    const auto results = scattered(froxels(view, stage.snapshot, {}), pixel_rays(view, stage.snapshot, 8));
    double least = 1;
    for (const Scatter& result : results) {
        ASSERT_TRUE(result.validity >= 0 && result.validity <= 1);
        least = std::min<double>(least, result.validity);
    }
    EXPECT_LT(least, 1);
}
}
}

// Beams of spots in the froxel cache: against quadrature of the closed form, and against the exact march.
#include "modes/froxel/froxel_fixtures.h"
#include "support/limitations.h"
#include "support/threads.h"

#include "base/random.h"
#include "integrate/equi_angular.h"
#include "modes/froxel/beams/beam_shadows.h"
#include "modes/froxel/limitations.h"
#include "modes/history.h"
#include "scene/lights/light_reach.h"
#include "trace/lights/light_ray.h"
#include "trace/shadows/cached_shadows.h"
#include "volume/phase.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
Settings with(const std::vector<std::string>& assignments) {
    Settings settings;
    for (const std::string& assignment : assignments) apply_setting(settings, assignment);
    return settings;
}

Light lamp_across() { return spot_light({-1.5f, 0.4f, 0.3f}, glm::normalize(vec3(1, -0.25f, 0.1f)), 5, 0.1f, 0.16f); }

Light bulb() { return point_light({-0.5f, 0.2f, 0.3f}, 5); }

// ∫ σ p e^-σt I(t)/d² dt along a ray through even fog that does not dim the light itself, by many midpoints of equal
// angle seen from the lamp.
double beam_through(const Light& light, const Medium& medium, const Ray& ray) {
    constexpr int count = 400;
    const double sigma = gray_extinction(medium.optics);
    const dvec3 origin(ray.origin), direction(ray.direction), lamp(light.position);
    const Interval<double> inside = intersection({0, ray.t_max}, light_reach(light, origin, direction));
    if (inside.empty()) return 0;
    const double nearest = glm::dot(lamp - origin, direction);
    const double height = glm::length(origin + nearest * direction - lamp);
    const EquiAngular<double> angles = equi_angular(nearest, height, inside.low, inside.high);
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const auto [t, length] = angles.at((i + 0.5) / count);
        const vec3 point(origin + t * direction);
        const LightSample arriving = arrival(light, point);
        const float cosine = glm::dot(arriving.to_light, ray.direction);
        sum += double(arriving.irradiance.x) * phase_value(medium.optics.phase, cosine) * std::exp(-sigma * t) * length;
    }
    return sum * sigma / count;
}

// How far off the pixels of a lamp in even fog are from its integral, at most, in shares of that and of the mean.
void expect_own_integrals(Light lamp, float g, const char* lookup, float share, float of_mean) {
    // Froxels of 8 pixels are as wide as the beam next to the lamp.
    const View view = view_of({0, 0, 4}, {0, 0, 0}, {96, 54});
    const Medium fog = homogeneous_medium(0.2f, {vec3(-30), vec3(30)}, Phase{PhaseKind::henyey_greenstein, g});
    lamp.range = 6;
    const Snapshot snapshot = snapshot_of({fog}, {lamp});
    const Settings settings = as_wide(with({"terms.light=off", std::string("froxel.lookup=") + lookup}), view.size);
    const std::vector<Ray> rays = pixel_rays(view, snapshot, 20);
    const std::vector<Scatter> results = scattered(froxels(view, snapshot, settings), rays);
    double most = 0, mean = 0;
    std::vector<double> truth;
    for (const Ray& ray : rays) {
        truth.push_back(beam_through(lamp, fog, ray));
        most = std::max(most, truth.back()), mean += truth.back() / static_cast<double>(rays.size());
    }
    EXPECT_GT(most, 8 * mean); // the lamp is in view
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_NEAR(results[i].radiance.x, truth[i], share * truth[i] + of_mean * mean)
            << i % 96 << ' ' << i / 96 << " g " << g << " radius " << lamp.radius << lookup;
}

TEST(FroxelBeam, EachPixelHasItsOwnIntegral) {
    for (const float g : {0.0f, 0.7f})
        for (const float radius : {0.0f, 0.05f})
            for (const char* lookup : {"trilinear", "tricubic"}) {
                Light lamp = lamp_across();
                lamp.radius = radius;
                expect_own_integrals(lamp, g, lookup, 0.02f, 0.002f);
            }
}

TEST(FroxelBeam, PixelsNearALampHaveTheirOwnIntegral) {
    for (const float g : {0.0f, 0.7f})
        for (const float radius : {0.0f, 0.05f})
            for (const char* lookup : {"trilinear", "tricubic"}) {
                Light lamp = bulb();
                lamp.radius = radius;
                expect_own_integrals(lamp, g, lookup, 0.03f, 0.01f);
            }
}

// A beam through two kinds of fog, half of it cut off by a slab.
TestScene beam_behind_slab() {
    const Medium mist =
        homogeneous_medium(0.15f, {vec3(-3), vec3(3)}, Phase{PhaseKind::henyey_greenstein, 0.6f}, {0.9f, 0.6f, 0.3f});
    Medium banks = medium_of(unit_volume(16, [](vec3 p) { return p.x * p.y + 0.2f; }), 0.4f);
    return make_scene({mist, banks}, {lamp_across()}, {box_of({-0.5f, -0.6f, -0.4f}, {-0.4f, 0.15f, 1})}, vec3(0.01f));
}

TEST(FroxelBeam, ShadowsAndSeveralFogsAreThoseOfTheReference) {
    const TestScene stage = beam_behind_slab();
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0}, {96, 54});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 12);
    const std::vector<Scatter> truth = marched(stage.snapshot, exact_settings(), rays);
    for (const char* way : {"froxel.visibility=intervals", "froxel.visibility=rays", "froxel.lookup=tricubic"}) {
        // What is left is the edge of the slab's shadow, as wide as a froxel.
        const Settings wide = as_wide(with({way}), view.size);
        EXPECT_LT(relative_rmse(scattered(froxels(view, stage.snapshot, wide), rays), truth), 0.12) << way;
    }
    const Settings fine = with({"froxel.tile=1", "froxel.depth_slices=256"});
    EXPECT_LT(relative_rmse(scattered(froxels(view, stage.snapshot, fine), rays), truth), 0.02);
}

// Lamps of any kind in fog of closed form: nothing is left to froxels of 8 pixels, shadows least of all.
TEST(FroxelBeam, LampsInFogOfClosedFormAreExact) {
    const Medium mist = homogeneous_medium(0.4f, {vec3(-3), vec3(2)}, Phase{PhaseKind::henyey_greenstein, -0.5f});
    const Medium cloud = homogeneous_medium(1.5f, {vec3(0.2f, -1, -1), vec3(1, 0.6f, 1)});
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0}, {96, 54});
    for (const Light& lamp : {lamp_across(), point_light({-1.2f, 0.1f, -6}, 5)}) { // one of them behind the scene
        const TestScene stage =
            make_scene({mist, cloud}, {lamp}, {box_of({-0.5f, -0.6f, -0.4f}, {-0.4f, 0.15f, 1})}, vec3(0));
        const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 12);
        const std::vector<Scatter> truth = marched(stage.snapshot, exact_settings(), rays);
        const auto error = [&](const char* way) {
            return relative_rmse(scattered(froxels(view, stage.snapshot, as_wide(with({way}), view.size)), rays),
                                 truth);
        };
        EXPECT_LT(error("froxel.lookup=trilinear"), 0.015);
        EXPECT_LT(error("froxel.lookup=tricubic"), 0.015);
        EXPECT_GT(error("froxel.visibility=off"), 0.03); // there are shadows
    }
}

// Where the shadows of all lamps would take gigabytes they are those of froxels.
TEST(FroxelBeam, LampsTooManyForTheirShadowsAreDrawnByFroxels) {
    Mesh crowd; // out of sight and of the lamps' way
    for (int i = 0; i < 16000; ++i) {
        const Mesh one = quad({0.01f * static_cast<float>(i), -50, 0}, {0.01f, 0, 0}, {0, 0, 0.01f});
        const auto first = static_cast<uint32_t>(crowd.positions.size());
        crowd.positions.insert(crowd.positions.end(), one.positions.begin(), one.positions.end());
        for (const glm::uvec3 triangle : one.triangles) crowd.triangles.push_back(triangle + first);
    }
    constexpr int count = 50;
    Light lamp = point_light({-1.2f, 0.4f, 0.3f}, 5.0f / count);
    lamp.radius = 0.02f;
    const Medium mist = homogeneous_medium(0.15f, {vec3(-3), vec3(3)});
    const std::vector<Mesh> meshes{box_of({-0.5f, -0.6f, -0.4f}, {-0.4f, 0.15f, 1}), crowd};
    const TestScene many = make_scene({mist}, std::vector<Light>(count, lamp), meshes, vec3(0));
    const auto views = [](const Light& light) { return lamp_points(light); };
    EXPECT_FALSE(has_room_for_views(many.snapshot, views));
    EXPECT_TRUE(has_room_for_views(many.snapshot, [](const Light&) { return 1; }));

    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0}, {96, 54});
    const std::vector<Ray> rays = pixel_rays(view, many.snapshot, 12);
    lamp.intensity *= count;
    const std::vector<Scatter> truth =
        marched(make_scene({mist}, {lamp}, meshes, vec3(0)).snapshot, exact_settings(), rays);
    EXPECT_LT(relative_rmse(scattered(froxels(view, many.snapshot, {}), rays), truth), 0.12);
    EXPECT_GT(relative_rmse(scattered(froxels(view, many.snapshot, with({"froxel.visibility=off"})), rays), truth),
              0.12);
}

// The shadows of a lamp with a radius are the mean of those of its points, and far from those of its center.
TEST(FroxelBeam, ShadowsOfALampWithARadiusAreSoft) {
    const Medium mist = homogeneous_medium(0.4f, {vec3(-1), vec3(1)});
    const Medium banks = medium_of(unit_volume(16, [](vec3) { return 1.0f; }), 0.4f);
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0}, {96, 54});
    const std::vector<Mesh> slab{box_of({-0.9f, -0.6f, -0.4f}, {-0.8f, 0.15f, 1})};
    for (const Medium& fog : {mist, banks}) {
        Light lamp = point_light({-1.3f, 0.2f, 0.3f}, 5), soft = lamp;
        soft.radius = 0.1f;
        constexpr uint32_t count = 16;
        std::vector<Light> points;
        for (uint32_t i = 0; i < count; ++i) {
            points.push_back(lamp);
            const Sample2 u = sample2(i, 5);
            points.back().position = vec3(point_on(soft, {}, {u.x, u.y, random_unit(i, 1, 2, 3)}).at);
            points.back().intensity = lamp.intensity / float(count);
        }
        const TestScene many = make_scene({fog}, points, slab, vec3(0));
        const std::vector<Ray> rays = pixel_rays(view, many.snapshot, 12);
        const std::vector<Scatter> truth = marched(many.snapshot, exact_settings(), rays);
        const auto error = [&](const Light& light) {
            const TestScene stage = make_scene({fog}, {light}, slab, vec3(0));
            EXPECT_EQ(has_limitation(find_mode("froxel").limitations(view, stage.snapshot, Settings{}),
                                     limitation::few_lamp_points),
                      light.radius > 0);
            return relative_rmse(scattered(froxels(view, stage.snapshot, {}), rays), truth);
        };
        EXPECT_LT(error(soft), 0.13);
        EXPECT_GT(error(lamp), 2.5 * error(soft));
    }
}

// Half of a lamp's sphere is above the ceiling that it hangs from. The half below lights the room as march says.
TEST(FroxelBeam, ALampHalfInACeilingLightsTheRoomBelow) {
    const Medium mist = homogeneous_medium(0.4f, {vec3(-1), {1, 0.5f, 1}});
    const std::vector<Mesh> room{quad({-1, 0.5f, -1}, {2, 0, 0}, {0, 0, 2}),
                                 box_of({-0.2f, -0.6f, -0.4f}, {-0.1f, 0.15f, 0.2f})};
    const View view = view_of({0.2f, 0.1f, 4}, {0, 0, 0}, {96, 54});
    Light lamp = point_light({-0.5f, 0.45f, 0.1f}, 5);
    lamp.radius = 0.3f;
    const TestScene stage = make_scene({mist}, {lamp}, room, vec3(0));
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 12);
    const double truth = mean_of(marched(stage.snapshot, exact_settings(), rays));
    EXPECT_NEAR(mean_of(scattered(froxels(view, stage.snapshot, {}), rays)) / truth, 1, 0.05);
}

// In grid fog as in any, what lies next to a lamp is found by the rays themselves: its density changes within a froxel.
TEST(FroxelBeam, FogNextToALampIsThatOfTheReference) {
    const Medium banks =
        medium_of(unit_volume(48, [](vec3 p) { return 0.5f + 0.5f * std::sin(25 * p.x) * std::sin(25 * p.y); }), 2);
    const Light lamp = point_light({0.1f, 0.2f, 0.1f}, 5);
    const TestScene stage = make_scene({banks}, {lamp}, {box_of({0.2f, -0.2f, 0}, {0.3f, 0.5f, 0.2f})}, vec3(0));
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0}, {96, 54});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 12);
    const std::vector<Scatter> truth = marched(stage.snapshot, exact_settings(), rays);
    EXPECT_LT(relative_rmse(scattered(froxels(view, stage.snapshot, {}), rays), truth), 0.1);
}

// A trace of other fog in the froxels around a cloud's does not change how they are interpolated.
TEST(FroxelBeam, NothingIsLostAtTheEdgeOfFog) {
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0}, {96, 54});
    const Medium ball =
        medium_of(unit_volume(32, [](vec3 p) { return glm::length(p - 0.5f) < 0.3f ? 1.0f : 0.0f; }), 1);
    const Light lamp = spot_light({0.5f, 0.5f, 6}, {0, 0, -1}, 50, 0.1f, 0.16f); // behind the camera
    const Snapshot one = snapshot_of({ball}, {lamp});
    const Snapshot two = snapshot_of({ball, homogeneous_medium(1e-6f, ball.world_bounds)}, {lamp});
    const std::vector<Ray> rays = pixel_rays(view, one, 12);
    const Settings wide = as_wide(with({"froxel.tile=8"}), view.size);
    EXPECT_LT(relative_rmse(scattered(froxels(view, two, wide), rays), scattered(froxels(view, one, wide), rays)),
              1e-3);
}

// Waves of fog an eighth of its depth long, in front of a lamp and around it.
TestScene lamp_in_waves() {
    const Medium waves = medium_of(unit_volume(48, [](vec3 p) { return 0.5f + 0.5f * std::sin(25 * p.z); }), 2);
    return make_scene({waves}, {point_light({0.1f, 0.2f, 0.1f}, 5)}, {}, vec3(0));
}

TEST(FroxelBeam, FogFinerThanASliceIsSampledInStepsNearALamp) {
    const TestScene stage = lamp_in_waves();
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0}, {96, 54});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 12);
    const std::vector<Scatter> truth = marched(stage.snapshot, exact_settings(), rays);
    EXPECT_LT(relative_rmse(scattered(froxels(view, stage.snapshot, with({"froxel.depth_slices=16"})), rays), truth),
              0.1);
}

// Soft shadows and fog finer than froxels, in the image and its beams.
TEST(FroxelBeam, FinerFroxelsAreNoWorse) {
    const Medium banks =
        medium_of(unit_volume(64, [](vec3 p) { return 0.5f + 0.5f * std::sin(60 * p.x) * std::sin(60 * p.y); }), 0.5f);
    Light lamp = spot_light({0.5f, 0.95f, 0.5f}, {0, -1, 0}, 5, 0.4f, 0.5f);
    lamp.radius = 0.02f;
    const TestScene stage = make_scene({banks}, {lamp}, {box_of({0.3f, 0.6f, 0.4f}, {0.5f, 0.65f, 0.6f})}, vec3(0));
    const View view = view_of({0.5f, 0.5f, 3}, {0.5f, 0.5f, 0}, {96, 54});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 12);
    const std::vector<Scatter> truth = marched(stage.snapshot, exact_settings(), rays);
    const auto error = [&](const std::vector<std::string>& rung) {
        return relative_rmse(scattered(froxels(view, stage.snapshot, as_wide(with(rung), view.size)), rays), truth);
    };
    const double coarse = error({"froxel.tile=8", "froxel.depth_slices=64"});
    EXPECT_LT(error({"froxel.tile=4", "froxel.depth_slices=96", "froxel.shadow_rays=2"}), 1.05 * coarse);
    EXPECT_LT(error({"froxel.tile=2", "froxel.depth_slices=160", "froxel.shadow_rays=4"}), 1.05 * coarse);
}

TEST(FroxelBeam, ARayDoesNotKnowItsNeighborsNorTheThreads) {
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0});
    for (const TestScene& stage : {beam_behind_slab(), lamp_in_waves()}) {
        const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 12);
        for (const char* way : {"froxel.tile=8", "froxel.tile=3", "froxel.depth_slices=40"}) {
            const Settings settings = as_wide(with({way}), view.size);
            const auto seen = [&](size_t packet) {
                return [&, packet] { return scattered(froxels(view, stage.snapshot, settings), rays, packet); };
            };
            const std::vector<Scatter> alone = on_threads(1, seen(1)), packed = on_threads(3, seen(16));
            for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(alone[i].radiance, packed[i].radiance) << way << i;
        }
    }
}

TEST(FroxelBeam, StretchesContinueARayAndPartsAddUp) {
    const TestScene stage = beam_behind_slab();
    const View view = view_of({0.2f, 0.3f, 4}, {0, 0.1f, 0});
    History history;
    for (const bool remembered : {false, true}) {
        const ScatterFunction scatter = froxels(view, stage.snapshot, {}, remembered ? &history : nullptr);
        for (const float along : {0.4f, 1.2f}) { // before the slab, and behind it where light passes it
            const vec3 eye = view.camera.position, up(0, along > 1 ? 0.12f : 0, 0);
            const vec3 point = lamp_across().position + along * lamp_across().direction + up;
            Ray whole{eye, glm::normalize(point - eye), 1}, first = whole, second = whole;
            whole.t_max = 8, first.t_max = 4.1f;
            second.origin = whole.at(4.1f), second.t_max = 8 - 4.1f;
            const auto parts = scattered(scatter, {whole, first, second});
            const float sum = parts[1].radiance.x + parts[1].transmittance * parts[2].radiance.x;
            EXPECT_NEAR(sum / parts[0].radiance.x, 1, 0.02) << along;

            vec3 light[part_count(1)]{};
            const uint32_t id = 0;
            Scatter result;
            scatter({.rays = {&whole, 1}, .ids = {&id, 1}, .parts = light}, {&result, 1});
            EXPECT_GT(light[0].x, 0);
            EXPECT_NEAR((light[0] + light[1]).x / result.radiance.x, 1, 1e-5);
        }
    }
}
}
}

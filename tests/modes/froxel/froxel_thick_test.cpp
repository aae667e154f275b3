// Froxels of some optical depth, and scenes of any size.
#include "modes/froxel/froxel_fixtures.h"
#include "modes/froxel/settings.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
TEST(Froxel, ASliceIsSeenThroughItsOwnFog) {
    // Fog from z = 0 on, lit across the view as far as a roof leaves it open, in slices of optical depth 3/4. One edge
    // in a slice is exact: L = p E (e^-σa - e^-σb).
    constexpr float extinction = 0.5f;
    Settings settings;
    settings.of<FroxelSettings>().tile = 1, settings.of<FroxelSettings>().depth_slices = 4,
    settings.of<FroxelSettings>().depth_growth = 1;
    settings.terms.light = LightTransmittance::off;
    const View view = view_of({0, 0, 4}, {0, 0, 0}, {65, 37});
    for (const float edge : {0.2f, 0.75f, 1.4f, 3.1f, 4.4f, 5.9f})
        for (const bool front : {true, false}) {
            const TestScene stage = make_scene(
                {homogeneous_medium(extinction, {vec3(-50, -50, -6), vec3(50, 50, 0)})}, {sun_light({0, -1, 0}, 2)},
                {quad({-50, 60, front ? -edge - 100 : -edge}, {100, 0, 0}, {0, 0, 100})});
            const Scatter result =
                scattered(froxels(view, stage.snapshot, settings), {{{0, 0, 4}, {0, 0, -1}, 100}})[0];
            const double low = front ? 0 : edge, high = front ? edge : 6;
            const double lit = std::exp(-extinction * low) - std::exp(-extinction * high);
            EXPECT_NEAR(result.radiance.x / (2 / (4 * std::acos(-1.0)) * lit), 1, 1e-3) << edge << front;
        }
}

TEST(Froxel, TheSizeOfASceneDoesNotMatter) {
    // Everything s times as long, fog 1/s as dense, a lamp s² as strong.
    const auto picture = [](float s) {
        Light lamp = point_light({-s, 1.2f * s, 0}, 3 * s * s);
        lamp.radius = 0.1f * s;
        const TestScene stage = make_scene({homogeneous_medium(0.3f / s, {s * vec3(-3, 0, -3), s * vec3(3, 3, 3)})},
                                           {sun_light({0.3f, -1, 0.1f}, 2), lamp},
                                           {quad(s * vec3(-50, 4, -50), {50.2f * s, 0, 0}, {0, 0, 100 * s})});
        View view = view_of(s * vec3(0.5f, 1.5f, 9), s * vec3(0, 1.5f, 0));
        view.camera.near *= s;
        return scattered(froxels(view, stage.snapshot, {}), pixel_rays(view, stage.snapshot, 1000 * s));
    };
    const std::vector<Scatter> usual = picture(1);
    for (const float s : {1e-2f, 1e4f, 1e6f}) EXPECT_LT(relative_rmse(picture(s), usual), 2e-3) << s;
}

TEST(Froxel, ALampInThickFogShinesAsFarAsTheReferenceSays) {
    const Snapshot snapshot = snapshot_of({homogeneous_medium(2)}, {point_light({1, 1.5f, 1}, 10)});
    const View view = view_of({0, 0, 6}, {0, 0, 0}, {48, 27});
    const std::vector<Ray> rays = pixel_rays(view, snapshot);
    Settings settings;
    settings.of<FroxelSettings>().tile = 1;
    const std::vector<Scatter> results = scattered(froxels(view, snapshot, settings), rays);
    EXPECT_LT(relative_rmse(results, marched(snapshot, exact_settings(), rays)), 0.04);
}
}
}

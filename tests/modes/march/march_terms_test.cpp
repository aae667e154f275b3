// All kinds of visibility with all kinds of light-side transmittance, and how far they may differ.
#include "modes/froxel/froxel_fixtures.h"
#include "modes/shadow_map/settings.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Visibility visibilities[] = {Visibility::off, Visibility::rays, Visibility::maps, Visibility::exact,
                                   Visibility::intervals};
const LightTransmittance transmittances[] = {LightTransmittance::off, LightTransmittance::average,
                                             LightTransmittance::froxel, LightTransmittance::grid,
                                             LightTransmittance::marched};

TEST(MarchTerms, AllCombinationsAgree) {
    const Medium cloud = medium_of(unit_volume(16, [](vec3 p) { return p.x * p.y + 0.2f; }), 2.5f);
    const TestScene stage = make_scene({cloud}, {sun_light({0.4f, -1, -0.3f}, 1), point_light({1.5f, 1.3f, 0.4f}, 1)},
                                       {box_of({0.3f, 0.7f, 0.2f}, {0.6f, 0.9f, 0.5f})});
    const View view = view_of({0.5f, 0.8f, 3}, {0.5f, 0.5f, 0.5f}, {32, 18});
    const std::vector<Ray> rays = pixel_rays(view, stage.snapshot, 10);
    double mean[5][5];
    std::vector<Scatter> results[5][5];
    for (int v = 0; v < 5; ++v)
        for (int t = 0; t < 5; ++t) {
            Settings settings = settings_for(Quality::preview);
            settings.march.visibility = visibilities[v], settings.terms.light = transmittances[t];
            settings.march.step_share = 1.0f / 128, settings.march.step_voxels = 0.25f;
            // Cells of a thirtieth of the fog: the picture shows four times as much as the fog fills.
            settings.terms.light_resolution = transmittances[t] == LightTransmittance::froxel ? 128 : 32;
            settings.of<ShadowMapSettings>().resolution = 1024;
            results[v][t] = scattered(find_mode("march").prepare(view, stage.snapshot, settings, nullptr), rays);
            for (const Scatter& result : results[v][t])
                ASSERT_TRUE(is_finite(result.radiance) && result.radiance.x >= 0) << v << t;
            mean[v][t] = mean_of(results[v][t]);
        }
    for (int v = 0; v < 5; ++v) {
        // In cells at the fog's rim, 2 of 30 on a path, depths may be off by half of what a cell gains: 2.5 / 30 / 2,
        // so 4 % of the light. The fog fills a tenth of the picture, which makes √10 of it beside the picture's mean.
        EXPECT_LT(relative_rmse(results[v][2], results[v][4]), 0.03) << v;
        EXPECT_LT(relative_rmse(results[v][3], results[v][4]), 0.03) << v;
        // Light that nothing dims is brighter by up to e^depth; an average depth errs to either side by less.
        EXPECT_GT(mean[v][0], 1.1 * mean[v][4]) << v;
        EXPECT_LT(std::abs(mean[v][1] - mean[v][4]), mean[v][0] - mean[v][4]) << v;
    }
    for (int t = 0; t < 5; ++t) {
        EXPECT_GT(mean[0][t], 1.01 * mean[3][t]) << t; // shadows take light away
        // 128 steps, the ends of shadows anywhere in them: half a step of some 50 in shadow.
        EXPECT_LT(relative_rmse(results[1][t], results[3][t]), 0.02) << t;
        EXPECT_LT(relative_rmse(results[2][t], results[3][t]), 0.03) << t;  // and texels
        EXPECT_LT(relative_rmse(results[4][t], results[3][t]), 0.002) << t; // steps of a quarter voxel
    }
}
}
}

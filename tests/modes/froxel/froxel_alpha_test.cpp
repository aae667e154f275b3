// Froxels behind surfaces that let a share of the light through.
#include "modes/froxel/froxel_fixtures.h"
#include "support/limitations.h"

#include "modes/froxel/limitations.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// Half of the fog is behind an opaque roof, all of it below a sheet.
TestScene roofed_fog(const Light& light, float alpha) {
    TestScene stage = make_scene(
        {homogeneous_medium(0.3f, {vec3(-3, 0, -3), vec3(3, 3, 3)})}, {light},
        {quad({-50, 4, -50}, {50.2f, 0, 0}, {0, 0, 100}), quad({-50, 6.8f, -50}, {100, 0, 0}, {0, 0, 100}, 0)});
    stage.scene->materials[0].alpha = alpha;
    return stage;
}

TEST(FroxelAlpha, ASheetOverAllHalvesWhatOpaqueSurfacesLeave) {
    const View view = view_of({0.5f, 1.5f, 9}, {0, 1.5f, 0});
    const Light sun = sun_light({0.3f, -1, 0.1f}, 2);
    const Light spot = spot_light({0.2f, 7, 0.1f}, {0, -1, 0}, 90, 0.2f, 0.5f);
    Light softbox = spot;
    softbox.radius = 0.1f;
    for (const Light& light : {sun, spot, softbox})
        for (const char* samples : {"froxel.shadow_rays=1", "froxel.shadow_rays=4"}) {
            const TestScene open = roofed_fog(light, 0), below = roofed_fog(light, 0.5f);
            const std::vector<Ray> rays = pixel_rays(view, open.snapshot);
            Settings settings;
            apply_setting(settings, samples);
            const std::vector<Scatter> plain = scattered(froxels(view, open.snapshot, settings), rays);
            const std::vector<Scatter> dimmed = scattered(froxels(view, below.snapshot, settings), rays);
            const double mean = mean_of(plain);
            ASSERT_GT(mean, 0);
            for (size_t i = 0; i < rays.size(); ++i)
                ASSERT_NEAR(dimmed[i].radiance.x, 0.5f * plain[i].radiance.x, 2e-3 * mean)
                    << i % 64 << ' ' << i / 64 << ' ' << light.name << ' ' << samples;
            EXPECT_TRUE(has_limitation(find_mode("froxel").limitations(view, below.snapshot, settings),
                                       limitation::coarse_alpha_shadows));
        }
}

// Froxels at the slit's edges lie half behind the wall: what is there tells nothing of the pane.
TEST(FroxelAlpha, APaneInASlitHalvesItsBeam) {
    const auto light = [](float alpha) {
        TestScene stage =
            make_scene({homogeneous_medium(0.3f, {vec3(-3, 0, -3), vec3(3, 3, 3)})}, {sun_light({0.3f, -1, 0.1f}, 2)},
                       {quad({-50, 4, -50}, {50.2f, 0, 0}, {0, 0, 100}), quad({0.9f, 4, -50}, {50, 0, 0}, {0, 0, 100}),
                        quad({0.2f, 4, -50}, {0.7f, 0, 0}, {0, 0, 100}, 0)});
        stage.scene->materials[0].alpha = alpha;
        const View view = view_of({0.5f, 1.5f, 9}, {0, 1.5f, 0});
        return mean_of(scattered(froxels(view, stage.snapshot, {}), pixel_rays(view, stage.snapshot)));
    };
    EXPECT_NEAR(light(0.5f) / light(0), 0.5, 0.01);
}

TEST(FroxelAlpha, StripsFinerThanAFroxelDimByTheirMean) {
    std::vector<Mesh> strips; // half of the roof is half transparent
    for (int i = 0; i < 400; ++i)
        strips.push_back(quad({-10 + 0.05f * static_cast<float>(i), 4, -50}, {0.025f, 0, 0}, {0, 0, 100}, 0));
    const std::vector<Medium> fog{homogeneous_medium(0.3f, {vec3(-3, 0, -3), vec3(3, 3, 3)})};
    const Light sun = sun_light({0.3f, -1, 0.1f}, 2);
    const TestScene below = make_scene(fog, {sun}, strips), open = make_scene(fog, {sun}, {});
    const View view = view_of({0.5f, 1.5f, 9}, {0, 1.5f, 0});
    const std::vector<Ray> rays = pixel_rays(view, below.snapshot);
    const auto light = [&](const TestScene& stage) {
        return mean_of(scattered(froxels(view, stage.snapshot, {}), rays));
    };
    EXPECT_NEAR(light(below) / light(open), 0.75, 0.0075);
}
}
}

// Fog through a lens: the techniques that follow rays of a lens agree, the others see it through the middle and say so.
#include "modes/lens_fog.h"

#include "base/random.h"
#include "integrate/ray_batch.h"
#include "modes/fog_buffer.h"
#include "modes/mode.h"
#include "modes/resolution.h"
#include "modes/settings.h"
#include "modes/shadow_map/settings.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/limitations.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/occlusion/occluders.h"
#include "trace/small_scenes.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr ivec2 size(64, 36);

View lens_view(float radius) {
    View view = view_of({0, 1, 6}, {0, 1, 0}, size);
    view.camera.lens = {radius, 3, 0, 0};
    return view;
}

// A spot before a box in fog, far behind what is in focus.
TestScene hazy_stage(bool with_box = true) {
    std::vector<Mesh> meshes{floor_of(-1, 6)};
    if (with_box) meshes.push_back(box_of({-0.4f, 0.4f, -0.4f}, {0.4f, 1, 0.4f}));
    const Box fog{vec3(-3, -1, -3), vec3(3, 4, 3)};
    Light lamp = point_light({0.2f, 2.2f, -0.3f}, 20);
    lamp.name = "lamp";
    return make_scene({homogeneous_medium(0.2f, fog, forward_phase(0.3f))}, {lamp}, std::move(meshes));
}

// One ray of the lens for each pixel, up to the first surface.
std::vector<Ray> lens_rays(const View& view, const Snapshot& snapshot) {
    std::vector<Ray> rays;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            rays.push_back(sample_ray(view, vec2(x, y) + 0.5f, sample_index(view, {x, y}, 0)));
            Hits hits;
            hits.instance.fill(-1);
            snapshot.occluders->closest({&rays.back(), 1}, 0, hits);
            rays.back().t_max = hits.instance[0] >= 0 ? hits.t[0] : 1000;
        }
    return rays;
}

Settings quick_settings() {
    Settings settings = settings_for(Quality::final);
    settings.fluence.orders = settings.path.orders = 1;
    return settings;
}

TEST(LensFog, MarchFindsShadowsFromEveryPointOfTheLens) {
    const TestScene stage = hazy_stage();
    const View view = lens_view(0.3f);
    const std::vector<Ray> rays = lens_rays(view, stage.snapshot);
    const auto intervals = run_mode("march", view, stage.snapshot, exact_settings(), rays);
    const auto sampled = run_mode("march", view, stage.snapshot, sampled_settings(), rays);
    EXPECT_GT(mean_of(intervals), 0);
    EXPECT_LT(relative_rmse(sampled, intervals), 0.01);
}

TEST(LensFog, MarchAgreesWithPath) {
    const TestScene stage = hazy_stage();
    const View view = lens_view(0.3f);
    const std::vector<Ray> rays = lens_rays(view, stage.snapshot);
    const double truth = mean_of(run_mode("march", view, stage.snapshot, exact_settings(), rays));
    const ScatterFunction scatter = find_mode("path").prepare(view, stage.snapshot, quick_settings(), nullptr);
    double sum = 0, squares = 0;
    constexpr int rounds = 48;
    for (uint32_t round = 0; round < rounds; ++round) {
        std::vector<Scatter> results(rays.size());
        for (size_t first = 0; first < rays.size(); first += 16) {
            std::vector<uint32_t> ids;
            for (uint32_t i = 0; i < 16; ++i) ids.push_back(hash(static_cast<uint32_t>(first) + i, round));
            scatter({.rays = std::span(rays).subspan(first, 16), .ids = ids}, std::span(results).subspan(first, 16));
        }
        const double mean = mean_of(results);
        sum += mean, squares += mean * mean;
    }
    const double mean = sum / rounds, error = std::sqrt((squares / rounds - mean * mean) / (rounds - 1));
    EXPECT_LT(error, 0.01 * truth);
    EXPECT_NEAR(mean, truth, 3.5 * error);
}

TEST(LensFog, TechniquesThatFollowRaysAreRight) {
    const TestScene open = hazy_stage(false), shadowed = hazy_stage();
    const View view = lens_view(0.3f);
    for (const auto& [mode, stage, most] : {std::tuple{"cone", &open, 0.01}, {"shadow-map", &shadowed, 0.06}}) {
        SCOPED_TRACE(mode);
        const std::vector<Ray> rays = lens_rays(view, stage->snapshot);
        const auto truth = run_mode("march", view, stage->snapshot, exact_settings(), rays);
        EXPECT_LT(relative_rmse(run_mode(mode, view, stage->snapshot, quick_settings(), rays), truth), most);
        EXPECT_FALSE(has_limitation(find_mode(mode).limitations(view, stage->snapshot, quick_settings()),
                                    limitation::fog_through_middle));
    }
}

// What they show of a ray of the lens is what they show of the pinhole's ray to the same point in focus.
TEST(LensFog, OthersSeeItThroughTheMiddle) {
    const TestScene stage = hazy_stage();
    const View view = lens_view(0.3f), pinhole = lens_view(0);
    const std::vector<Ray> sharp = pixel_rays(pinhole, stage.snapshot);
    std::vector<Ray> rays = lens_rays(view, stage.snapshot);
    for (size_t i = 0; i < rays.size(); ++i) { // as deep as the pinhole's rays
        const vec3 forward = view.camera.forward;
        rays[i].t_max = sharp[i].t_max * glm::dot(sharp[i].direction, forward) / glm::dot(rays[i].direction, forward);
    }
    for (const char* mode : {"froxel", "shadow-volume", "billboard"}) {
        SCOPED_TRACE(mode);
        const auto seen = run_mode(mode, view, stage.snapshot, quick_settings(), rays);
        const auto expected = run_mode(mode, pinhole, stage.snapshot, quick_settings(), sharp);
        EXPECT_GT(mean_of(expected), 0);
        EXPECT_LT(relative_rmse(seen, expected), 2e-3);
    }
}

TEST(LensFog, TheBlurThatIsMissingIsTheLamps) {
    const TestScene stage = hazy_stage();
    const View view = lens_view(0.3f);
    const double expected = static_cast<double>(blur_diameter(view.camera, size, 9)); // where the fog ends
    for (const char* mode : {"froxel", "shadow-volume", "billboard", "radial-blur"}) {
        SCOPED_TRACE(mode);
        const Limitations told = find_mode(mode).limitations(view, stage.snapshot, quick_settings());
        const auto found =
            std::ranges::find_if(told, [](const Limitation& one) { return one.is(limitation::fog_through_middle); });
        ASSERT_NE(found, told.end());
        EXPECT_EQ(found->severity, Severity::degraded);
        EXPECT_GT(found->amounts[0], 0.9 * static_cast<double>(blur_diameter(view.camera, size, 6.3f)));
        EXPECT_LT(found->amounts[0], 1.3 * expected);
        EXPECT_FALSE(has_limitation(find_mode(mode).limitations(lens_view(0), stage.snapshot, quick_settings()),
                                    limitation::fog_through_middle));
    }
}

TEST(LensFog, TheBlurThatIsMissingIsThatOfTheNearestBeam) {
    const View view = lens_view(0.3f);
    const Box fog{vec3(-3, -1, -6), vec3(3, 4, 6)};
    const Light beam = spot_light({0, 4, 5}, {0, -1, 0}, 20, 0.1f, 0.12f); // a meter before the camera
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.01f, fog)}, {beam});
    const Limitations told = find_mode("froxel").limitations(view, snapshot, quick_settings());
    const auto found =
        std::ranges::find_if(told, [](const Limitation& one) { return one.is(limitation::fog_through_middle); });
    ASSERT_NE(found, told.end());
    EXPECT_GT(found->amounts[0], 0.7 * static_cast<double>(blur_diameter(view.camera, size, 1)));
    EXPECT_LT(found->amounts[0], 2 * static_cast<double>(blur_diameter(view.camera, size, 1)));
    EXPECT_NEAR(found->amounts[1], 1, 0.6);
}

TEST(LensFog, APictureOfTheFogIsNotUsed) {
    const TestScene stage = hazy_stage();
    const View view = lens_view(0.3f);
    Settings half = quick_settings();
    half.of<ShadowMapSettings>().fog_resolution = Resolution::half;
    const std::vector<Ray> rays = lens_rays(view, stage.snapshot);
    const auto a = run_mode("shadow-map", view, stage.snapshot, half, rays);
    const auto b = run_mode("shadow-map", view, stage.snapshot, quick_settings(), rays);
    EXPECT_EQ(rms_difference(a, b), 0);
    EXPECT_TRUE(
        has_limitation(find_mode("shadow-map").limitations(view, stage.snapshot, half), limitation::no_fog_picture));
}
}
}

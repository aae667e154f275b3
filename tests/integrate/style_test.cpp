// Artist's controls against the closed forms they bend.
#include "integrate/style.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "support/run_mode.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

// A slab lit by a sun from above, seen from the side: L = σ E / (4π) ∫ e^{-a σ t} e^{-b σ h} dt.
struct Slab {
    static constexpr double sigma = 0.4, height = 2, length = 5;
    Snapshot snapshot = snapshot_of({homogeneous_medium(sigma, Box{vec3(-50, -50, -50), vec3(50, height, 50)})},
                                    {sun_light({0, -1, 0}, 7)}, vec3(0));
    Ray ray{vec3(0), vec3(1, 0, 0), length};

    double expected(double light, double view) const {
        const double k = view * sigma;
        const double along = k > 0 ? -std::expm1(-k * length) / k : length;
        return sigma * 7 / (4 * double(pi)) * std::exp(-light * sigma * height) * along;
    }
};

class Styles : public testing::TestWithParam<Visibility> {
protected:
    Settings settings() const {
        Settings settings = GetParam() == Visibility::exact ? exact_settings() : sampled_settings();
        settings.march.visibility = GetParam();
        settings.march.visibility = GetParam();
        return settings;
    }
};
INSTANTIATE_TEST_SUITE_P(March, Styles, testing::Values(Visibility::rays, Visibility::intervals, Visibility::exact));

TEST_P(Styles, DepthsOfLightAndViewAreScaledApart) {
    const Slab slab;
    for (const auto& [light, view] : {std::pair(1.0f, 1.0f), {0.25f, 1.0f}, {1.0f, 3.0f}, {0.0f, 0.0f}, {2.0f, 0.5f}}) {
        Settings styled = settings();
        styled.style.light_depth = light, styled.style.view_depth = view;
        const Scatter result = marched(slab.snapshot, styled, slab.ray);
        EXPECT_NEAR(result.radiance.x / slab.expected(light, view), 1, 1e-4) << light << " " << view;
        EXPECT_NEAR(result.transmittance, std::exp(-Slab::sigma * Slab::length), 1e-5);
        EXPECT_EQ(is_stylized(styled.style), light != 1 || view != 1);
    }
}

TEST_P(Styles, DensityThickensAndTintColors) {
    const Slab slab;
    Settings styled = settings();
    styled.style.density = 2;
    EXPECT_NEAR(marched(slab.snapshot, styled, slab.ray).transmittance, std::exp(-2 * Slab::sigma * Slab::length),
                1e-5);
    styled = settings();
    styled.style.tint = {2, 1, 0};
    const vec3 light = marched(slab.snapshot, styled, slab.ray).radiance;
    const double plain = slab.expected(1, 1);
    EXPECT_NEAR(light.x / plain, 2, 1e-3);
    EXPECT_NEAR(light.y / plain, 1, 1e-3);
    EXPECT_EQ(light.z, 0);
}

// The fog's light ends at the range, and fades over its last fifth: ∫ of a ramp.
TEST_P(Styles, RangeFades) {
    Slab slab;
    for (Medium& medium : slab.snapshot.media) medium.optics.extinction = vec3(1e-4f);
    Settings styled = settings();
    styled.march.step_share = 1e-3f;
    View view;
    view.camera.position = slab.ray.origin;
    const auto light = [&](const Settings& some) {
        const ScatterFunction scatter = find_mode("march").prepare(view, slab.snapshot, some, nullptr);
        Scatter result;
        const uint32_t id = 1;
        scatter({.rays = {&slab.ray, 1}, .ids = {&id, 1}}, {&result, 1});
        return result.radiance.x;
    };
    const double plain = light(styled);
    styled.style.range = 2.5f;
    EXPECT_NEAR(light(styled) / plain, (2 + 0.25) / 5, 2e-3);
    EXPECT_TRUE(is_stylized(styled.style));
}

TEST(Style, FogWithoutDensityIsGone) {
    Slab slab;
    slab.snapshot.media.front().optics.emission.radiance = vec3(3);
    slab.snapshot.ambient = vec3(1);
    Settings styled;
    styled.style.density = 0;
    View view;
    view.camera.position = slab.ray.origin, view.size = ivec2(64);
    for (const char* mode : {"march", "froxel", "shadow-map", "shadow-volume", "cone", "billboard"}) {
        const Scatter seen = run_mode(mode, view, slab.snapshot, styled, {slab.ray}).front();
        EXPECT_EQ(seen.radiance, vec3(0)) << mode;
        EXPECT_EQ(seen.transmittance, 1) << mode;
    }
}

TEST(Style, EvenMediaKeepTheirMeanDensity) {
    const Medium grid = medium_of(unit_volume(8, [](vec3 p) { return p.x; }), 0.5f);
    const std::vector<Medium> even = homogeneous_media(std::vector{grid, homogeneous_medium(0.2f)});
    ASSERT_EQ(even.size(), 2u);
    EXPECT_EQ(even[0].density.kind, DensityKind::homogeneous);
    EXPECT_FLOAT_EQ(gray_extinction(even[0].optics), 0.5f * grid.density.bricks->mean);
    EXPECT_EQ(gray_extinction(even[1].optics), 0.2f);
}
}
}

// Light as displays show it.
#include "render/image/view_transform.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
vec3 filmic(vec3 linear) { return display_value(linear, {0, ViewTransform::filmic}); }
}

TEST(ViewTransform, IsThePublishedCurveForGrays) {
    // Matrices, polynomial and look as published, evaluated in double precision by another program, over the value of
    // the polynomial at its end.
    const std::pair<float, float> published[] = {{0.01f, 3.30f},  {0.05f, 42.04f}, {0.18f, 99.33f}, {0.5f, 152.51f},
                                                 {1.0f, 186.25f}, {2.0f, 214.01f}, {4.0f, 233.64f}, {8.0f, 245.70f}};
    for (const auto& [linear, code] : published)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(filmic(vec3(linear))[c], code, 0.15) << linear;
    EXPECT_EQ(filmic(vec3(0)), vec3(0));
    EXPECT_NEAR(filmic(vec3(100)).x, 255, 0.3);
}

TEST(ViewTransform, FilmicNeverFallsAndLeavesRoomForHighlights) {
    float before = 0;
    for (int i = 0; i < 2000; ++i) {
        const float value = filmic(vec3(std::exp2(-12 + 0.01f * static_cast<float>(i)))).y;
        EXPECT_GE(value, before - 1e-3f) << i;
        before = value;
    }
    // A stop is still told apart where plain sRGB has been white for three.
    EXPECT_GT(filmic(vec3(16)).x - filmic(vec3(8)).x, 5);
    EXPECT_EQ(display_value(vec3(16), {0, ViewTransform::srgb}), display_value(vec3(1), {0, ViewTransform::srgb}));
}

TEST(ViewTransform, BrightColorsKeepTheirHueOnTheWayToWhite) {
    for (const vec3 color :
         {vec3(1, 0.62f, 0.28f), vec3(0.2f, 0.4f, 1), vec3(0.1f, 0.9f, 0.2f), vec3(1, 0.05f, 0.02f)}) {
        float spread = infinity;
        for (int stop = 0; stop < 9; ++stop) {
            const vec3 shown = filmic(std::exp2(static_cast<float>(stop)) * color);
            const float low = std::min({shown.x, shown.y, shown.z}), high = max_component(shown);
            // The brightest and the darkest channel stay the brightest and the darkest.
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(shown[c], color[c] == max_component(color) ? high - 0.5f : low);
                EXPECT_LE(shown[c], color[c] == std::min({color.x, color.y, color.z}) ? low + 0.5f : high);
            }
            EXPECT_LE(high - low, stop > 2 ? spread + 0.5f : 255) << stop;
            spread = high - low;
        }
        EXPECT_LT(spread, 25);
    }
}

TEST(ViewTransform, TheTableIsWithinAHundredthOfACode) {
    for (int i = 0; i < 5000; ++i) {
        const double x = std::exp2(-19 + 0.004 * i);
        const double linear = std::min(x, 1.0);
        const double exact = 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
        EXPECT_NEAR(display_value(vec3(static_cast<float>(x)), {0, ViewTransform::srgb}).x, exact, 0.01) << x;
    }
}
}

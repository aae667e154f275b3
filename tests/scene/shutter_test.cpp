// Moments that stand for equal shares of the light.
#include "scene/shutter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tyndall {
namespace {
TEST(Shutter, IsOpenForATimeOnly) {
    EXPECT_FALSE(Shutter{});
    EXPECT_FALSE((Shutter{0.25, 0.25, {}}));
    EXPECT_TRUE((Shutter{-0.25, 0.25, {}}));
    EXPECT_DOUBLE_EQ((Shutter{-0.25, 0.75, {}}).middle(), 0.25);
}

TEST(Shutter, WithoutACurveMomentsAreEven) {
    const std::vector<double> times = shutter_times({-0.25, 0.25, {}}, 4);
    ASSERT_EQ(times.size(), 4u);
    for (int k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(times[static_cast<size_t>(k)], -0.25 + (k + 0.5) / 8);
}

// Of a triangle over 0..1 the share before t is 2 t² up to half time.
TEST(Shutter, ATriangleHasMoreOfThemAtHalfTime) {
    constexpr int count = 16;
    const std::vector<double> times = shutter_times({0, 1, {0, 1, 0}}, count);
    for (int k = 0; k < count / 2; ++k) {
        EXPECT_NEAR(times[static_cast<size_t>(k)], std::sqrt((k + 0.5) / count / 2), 1e-9);
        EXPECT_NEAR(times[static_cast<size_t>(count - 1 - k)], 1 - times[static_cast<size_t>(k)], 1e-9);
    }
}

TEST(Shutter, NoneIsWhereNoLightGetsThrough) {
    for (const double time : shutter_times({0, 4, {0, 0, 3, 0, 0}}, 64)) {
        EXPECT_GT(time, 1);
        EXPECT_LT(time, 3);
    }
    const std::vector<double> once = shutter_times({0, 1, {0, 1}}, 1);
    EXPECT_NEAR(once[0], std::sqrt(0.5), 1e-9);
}
}
}

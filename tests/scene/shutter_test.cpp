// Moments that stand for equal shares of the light.
#include "scene/shutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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

double mean_of(const std::vector<ExposedTime>& times, const std::function<double(double)>& value) {
    double sum = 0;
    for (const ExposedTime& exposed : times) sum += exposed.weight * value(exposed.time);
    return sum;
}

// Under a triangle over 0..1 a flash during 0.1..0.103 has the share 2 (0.103² - 0.1²) of the exposure.
TEST(Shutter, SharesOfTheExposureMissNoFlash) {
    const std::vector<double> breaks{0.1, 0.103};
    const auto flash = [](double time) { return time > 0.1 && time < 0.103 ? 1.0 : 0.0; };
    const auto shares = exposed_times({0, 1, {0, 1, 0}}, 4, breaks);
    ASSERT_EQ(shares.size(), 4u);
    double sum = 0;
    for (const std::vector<ExposedTime>& times : shares) {
        EXPECT_NEAR(mean_of(times, [](double) { return 1; }), 1, 1e-12);
        sum += mean_of(times, flash) / 4;
    }
    EXPECT_NEAR(sum, 2 * (0.103 * 0.103 - 0.1 * 0.1), 1e-12);
    EXPECT_EQ(mean_of(shares[3], flash), 0);
}

TEST(Shutter, SharesOfTheExposureAddUpToAll) {
    const Shutter shutter{-0.25, 0.5, {1, 0.2f, 0, 0.7f}};
    const auto curve = [](double time) { return std::exp2(9 * time); };
    const double all = mean_of(exposed_times(shutter, 1, {})[0], curve);
    double sum = 0;
    for (const std::vector<ExposedTime>& times : exposed_times(shutter, 7, {})) sum += mean_of(times, curve) / 7;
    EXPECT_NEAR(sum, all, 1e-7 * all); // of places where the curve is near 0, a root of the precision is known
}
}
}

// Densities of filters against the points drawn from them.
#include "base/random.h"
#include "trace/sampling/pixel_filter.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
class Filters : public testing::TestWithParam<PixelFilter> {};

TEST_P(Filters, DensityIsThatOfThePoints) {
    // Shares of points left of a few places against sums of the density.
    constexpr int count = 1 << 14, steps = 2000;
    for (const float place : {-0.6f, -0.2f, 0.3f, 0.8f}) {
        int left = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const Sample2 u = sample2(i, 7);
            left += filter_point(GetParam(), {u.x, u.y}).x < place;
        }
        double sum = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < steps; ++x) {
                const vec2 at(-1 + (place + 1) * (static_cast<float>(x) + 0.5f) / steps,
                              -1 + 2 * (static_cast<float>(y) + 0.5f) / 40);
                sum += filter_density(GetParam(), at) * (place + 1) / steps * 2 / 40;
            }
        EXPECT_NEAR(sum, 1.0 * left / count, 2e-3);
    }
}

TEST_P(Filters, NothingBeyondTheSquare) {
    EXPECT_EQ(filter_density(GetParam(), {1.01f, 0}), 0);
    EXPECT_EQ(filter_density(GetParam(), {0, -1.01f}), 0);
}

INSTANTIATE_TEST_SUITE_P(All, Filters,
                         testing::Values(PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian,
                                         PixelFilter::blackman_harris));
}
}

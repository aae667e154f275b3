#include "scene/lights/light_reach.h"

#include "base/random.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double endless = std::numeric_limits<double>::infinity();
const double deg = std::acos(-1.0) / 180;

void expect_stretch(Interval<double> stretch, double low, double high, double tolerance = 1e-12) {
    if (std::isinf(low))
        EXPECT_EQ(stretch.low, low);
    else
        EXPECT_NEAR(stretch.low, low, tolerance);
    if (std::isinf(high))
        EXPECT_EQ(stretch.high, high);
    else
        EXPECT_NEAR(stretch.high, high, tolerance);
}

TEST(Cone, KnownLines) {
    // A cone of 45° downwards from the origin.
    const dvec3 apex(0), down(0, -1, 0);
    const double half = 45 * deg;
    expect_stretch(inside_cone(apex, down, half, {-5, -2, 0}, {1, 0, 0}), 3, 7);          // across
    expect_stretch(inside_cone(apex, down, half, {-5, -2, 0}, {2, 0, 0}), 1.5, 3.5);      // any length
    expect_stretch(inside_cone(apex, down, half, {0, 3, 0}, {0, -1, 0}), 3, endless);     // down the axis
    expect_stretch(inside_cone(apex, down, half, {0, -3, 0}, {0, 1, 0}), -endless, 3);    // up the axis
    expect_stretch(inside_cone(apex, down, half, {0.5, 3, 0}, {0, -1, 0}), 3.5, endless); // beside it
    EXPECT_TRUE(inside_cone(apex, down, half, {-5, 2, 0}, {1, 0, 0}).empty());            // the mirrored cone
    EXPECT_TRUE(inside_cone(apex, down, half, {-5, -2, 2.5}, {1, 0, 0}).empty());         // beside
    EXPECT_TRUE(inside_cone(apex, down, half, {-5, 0, 0}, {1, 0, 0}).empty());            // touches the apex only
    // Along a generator, half a meter further in: from where |x| = -y on.
    const dvec3 generator = glm::normalize(dvec3(1, -1, 0));
    const Interval<double> along = inside_cone(apex, down, half, dvec3(0, -0.5, 0), generator);
    EXPECT_NEAR(along.low, -0.25 * std::sqrt(2.0), 1e-9);
    EXPECT_GT(along.high, 1e9);
}

TEST(Cone, HalfSpaceAndNeedle) {
    expect_stretch(inside_cone({0, 1, 0}, {0, -1, 0}, 90 * deg, {0, 3, 5}, {0, -1, 0}), 2, endless, 1e-7);
    expect_stretch(inside_cone({0, 0, 0}, {0, -1, 0}, 0.01 * deg, {-1, -10, 0}, {1, 0, 0}),
                   1 - 10 * std::tan(0.01 * deg), 1 + 10 * std::tan(0.01 * deg), 1e-11);
    EXPECT_TRUE(inside_cone({0, 0, 0}, {0, -1, 0}, 0, {-1, -10, 0.1}, {1, 0, 0}).empty());
}

TEST(Cone, EndsAreWhereTheAngleIsHalfTheOpening) {
    for (uint32_t i = 0; i < 20000; ++i) {
        const auto u = [&](uint32_t k) { return 2 * double(random_unit(i, 0, k, 9)) - 1; };
        const dvec3 apex(u(0), u(1), u(2)), origin = 4.0 * dvec3(u(3), u(4), u(5));
        const dvec3 axis = glm::normalize(dvec3(u(6), u(7), u(8))),
                    direction = glm::normalize(dvec3(u(9), u(10), u(11)));
        const double half = (1 + 44 * (u(12) + 1)) * deg;
        const Interval<double> stretch = inside_cone(apex, axis, half, origin, direction);
        const auto angle = [&](double t) {
            return std::acos(glm::dot(axis, glm::normalize(origin + t * direction - apex)));
        };
        // Every end lies on the cone; probes along the line lie where the stretch says.
        for (const double end : {stretch.low, stretch.high})
            if (!stretch.empty() && std::abs(end) < 1e3) {
                EXPECT_NEAR(angle(end), half, 1e-6) << i;
            }
        for (double t = -20; t < 20; t += 0.37)
            if (std::abs(angle(t) - half) > 1e-9) {
                EXPECT_EQ(angle(t) < half, t > stretch.low && t < stretch.high && !stretch.empty()) << i << " at " << t;
            }
    }
}

TEST(Cone, FarFromTheApexNothingCancels) {
    // A line across a beam of 1° a million meters away from its own origin.
    const double half = 1 * deg, out = 1e6;
    const Interval<double> stretch = inside_cone({0, 0, 0}, {0, -1, 0}, half, {-out, -10, 0}, {1, 0, 0});
    EXPECT_NEAR(stretch.low, out - 10 * std::tan(half), 1e-8);
    EXPECT_NEAR(stretch.high, out + 10 * std::tan(half), 1e-8);
}
}
}

#include "scene/keyed.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
Keyed<float> two_keys(Interpolation interpolation, bool loop = false) {
    Keyed<float> keys;
    keys.times = {1, 3}, keys.values = {10, 20};
    keys.interpolation = interpolation, keys.loop = loop;
    return keys;
}

TEST(Keyed, ConstantHoldsAlways) {
    const Keyed<float> value(4.0f);
    EXPECT_TRUE(value.constant());
    EXPECT_EQ(value.at(-1e9), 4);
    EXPECT_EQ(value.at(1e9), 4);
}

TEST(Keyed, HoldsOutsideItsKeys) {
    for (const auto kind : {Interpolation::step, Interpolation::linear, Interpolation::smooth}) {
        EXPECT_EQ(two_keys(kind).at(-5), 10);
        EXPECT_EQ(two_keys(kind).at(1), 10);
        EXPECT_EQ(two_keys(kind).at(3), 20);
        EXPECT_EQ(two_keys(kind).at(99), 20);
    }
}

TEST(Keyed, BetweenKeys) {
    EXPECT_EQ(two_keys(Interpolation::step).at(2.999), 10);
    EXPECT_FLOAT_EQ(two_keys(Interpolation::linear).at(1.5), 12.5f);
    EXPECT_FLOAT_EQ(two_keys(Interpolation::smooth).at(1.5), 10 + 10 * (3 * 0.0625f - 2 * 0.015625f));
    EXPECT_FLOAT_EQ(two_keys(Interpolation::smooth).at(2), 15);
}

TEST(Keyed, LoopRepeatsForwardsAndBackwards) {
    const Keyed<float> keys = two_keys(Interpolation::linear, true);
    for (const double turns : {-1000.0, -3.0, -1.0, 1.0, 7.0, 1000.0})
        EXPECT_NEAR(keys.at(1.5 + 2 * turns), 12.5, 1e-4) << turns;
    EXPECT_FLOAT_EQ(keys.at(3), 10) << "the end of a loop is its start";
    EXPECT_FLOAT_EQ(keys.at(0.5), 17.5f);
}

TEST(Keyed, TimesFarFromZeroKeepTheirPrecision) {
    EXPECT_NEAR(two_keys(Interpolation::linear, true).at(1e6 + 0.25),
                two_keys(Interpolation::linear, true).at(0.25 + 2), 1e-5);
}

TEST(Keyed, TellsItsKeysWithinATime) {
    const auto between = [](const Keyed<float>& keys, double from, double to) {
        std::vector<double> times;
        add_key_times(keys, from, to, times);
        return times;
    };
    EXPECT_TRUE(between(4.0f, -10, 10).empty());
    EXPECT_EQ(between(two_keys(Interpolation::step), 0, 2), std::vector<double>{1});
    EXPECT_EQ(between(two_keys(Interpolation::step, true), 4, 8), (std::vector<double>{5, 5, 7, 7})) << "ends meet";
    EXPECT_TRUE(between(two_keys(Interpolation::step, true), 0, 1e9).empty()) << "too many";
    Keyed<float> fast;
    fast.times = {0, 1e-30f}, fast.values = {0, 1}, fast.loop = true;
    EXPECT_TRUE(between(fast, 0.02, 0.04).empty()) << "and no end";
    EXPECT_TRUE(between(fast, 1e12, 1e12 + 1e-3).empty());
}

// A Hermite spline reproduces any cubic from its values and slopes: f(t) = t³ - 2t² + 3t - 1.
TEST(Keyed, CubicReproducesACubic) {
    const auto f = [](double t) { return t * t * t - 2 * t * t + 3 * t - 1; };
    const auto slope = [](double t) { return 3 * t * t - 4 * t + 3; };
    Keyed<float> keys;
    keys.interpolation = Interpolation::cubic;
    keys.values.clear();
    for (const float t : {-1.0f, 0.5f, 2.0f, 4.5f}) {
        keys.times.push_back(t);
        for (const double value : {slope(t), f(t), slope(t)}) keys.values.push_back(static_cast<float>(value));
    }
    for (double t = -1; t <= 4.5; t += 0.125) EXPECT_NEAR(keys.at(t), f(t), 2e-5 * (1 + std::abs(f(t)))) << t;
    EXPECT_FLOAT_EQ(keys.at(-9), static_cast<float>(f(-1)));
    EXPECT_FLOAT_EQ(keys.at(9), static_cast<float>(f(4.5)));
}

TEST(Keyed, CubicWithOneKeyIsItsValue) {
    Keyed<vec3> keys;
    keys.interpolation = Interpolation::cubic;
    keys.times = {2}, keys.values = {vec3(9), vec3(1, 2, 3), vec3(9)};
    EXPECT_EQ(keys.at(0), vec3(1, 2, 3));
    EXPECT_EQ(keys.at(5), vec3(1, 2, 3));
}

TEST(Keyed, QuaternionsTurnEvenlyTheShortWay) {
    const auto about_y = [](float degrees) { return glm::angleAxis(glm::radians(degrees), vec3(0, 1, 0)); };
    Keyed<quat> keys;
    keys.times = {0, 1}, keys.values = {about_y(10), -about_y(100)}; // the same turn, the other sign
    for (const float share : {0.0f, 0.25f, 0.5f, 0.9f, 1.0f}) {
        const quat value = keys.at(share), expected = about_y(10 + 90 * share);
        EXPECT_NEAR(std::abs(glm::dot(value, expected)), 1, 1e-6) << share;
        EXPECT_NEAR(glm::length(value), 1, 1e-6);
    }
}

TEST(Keyed, CubicQuaternionsStayUnit) {
    Keyed<quat> keys;
    keys.interpolation = Interpolation::cubic;
    keys.times = {0, 1};
    const quat none(0, 0, 0, 0), from(1, 0, 0, 0), to = glm::angleAxis(2.0f, glm::normalize(vec3(1, 2, 3)));
    keys.values = {none, from, quat(0, 3, 0, 0), quat(0, 0, 4, 0), to, none};
    for (double t = 0; t <= 1; t += 0.1) EXPECT_NEAR(glm::length(keys.at(t)), 1, 1e-6);
}
}
}

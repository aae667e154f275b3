#include "volume/noise/noise_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall::testing {
namespace {
// The largest value over unit gradients of a term that is linear in them is the sum of the lengths of their factors.
struct Peaks {
    double value = 0, slope = 0, bend = 0, twist = 0;
};
Peaks largest_over_a_cell(int steps) {
    const auto f = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const auto f1 = [](double t) { return 30 * t * t * (t - 1) * (t - 1); };
    const auto f2 = [](double t) { return 60 * t * (2 * t * t - 3 * t + 1); };
    Peaks peaks;
    for (int a = 0; a <= steps; ++a)
        for (int b = 0; b <= steps; ++b)
            for (int c = 0; c <= steps / 2; ++c) {
                const dvec3 p = dvec3(a, b, c) / double(steps);
                Peaks sum;
                for (int corner = 0; corner < 8; ++corner) {
                    dvec3 w, w1, w2, d;
                    for (int k = 0; k < 3; ++k) {
                        const int side = corner >> k & 1;
                        d[k] = p[k] - side, w[k] = side ? f(p[k]) : 1 - f(p[k]);
                        w1[k] = side ? f1(p[k]) : -f1(p[k]), w2[k] = side ? f2(p[k]) : -f2(p[k]);
                    }
                    const double wx = w1.x * w.y * w.z, wy = w.x * w1.y * w.z;
                    sum.value += w.x * w.y * w.z * glm::length(d);
                    sum.slope += glm::length(wx * d + dvec3(w.x * w.y * w.z, 0, 0));
                    sum.bend += glm::length(w2.x * w.y * w.z * d + dvec3(2 * wx, 0, 0));
                    sum.twist += glm::length(w1.x * w1.y * w.z * d + dvec3(wy, wx, 0));
                }
                peaks.value = std::max(peaks.value, sum.value), peaks.slope = std::max(peaks.slope, sum.slope);
                peaks.bend = std::max(peaks.bend, sum.bend), peaks.twist = std::max(peaks.twist, sum.twist);
            }
    return peaks;
}

TEST(NoiseBound, ConstantsAreTheLargestValuesOverACell) {
    const Peaks peaks = largest_over_a_cell(64);
    EXPECT_NEAR(peaks.value, noise_peak, 1e-6);
    EXPECT_LT(peaks.slope, noise_slope_peak);
    EXPECT_GT(peaks.slope, noise_slope_peak - 0.02);
    EXPECT_LT(peaks.bend, noise_bend_peak);
    EXPECT_GT(peaks.bend, noise_bend_peak - 0.05);
    EXPECT_LT(peaks.twist, noise_twist_peak);
    EXPECT_GT(peaks.twist, noise_twist_peak - 0.05);
}

// Boxes of every size and place; the bound has to hold at their corners, edges and inside.
void expect_no_violation(int boxes, uint32_t seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    for (int i = 0; i < boxes; ++i) {
        const FractalNoise noise{.octaves = 1 + i % 6,
                                 .scale = std::exp(uniform(-2, 2)),
                                 .lacunarity = uniform(1.5f, 2.5f),
                                 .gain = uniform(0.3f, 0.9f),
                                 .seed = static_cast<uint32_t>(random()),
                                 .billow = i % 3 == 0};
        const float reach = i % 5 == 0 ? 3000.0f : 30.0f, turn = uniform(0, 1);
        const vec3 low(uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach));
        const vec3 size = noise.scale * std::exp(uniform(-6, 1)) * vec3(uniform(0, 1), uniform(0, 1), uniform(0, 1));
        const Box box{low, low + size};
        Points points = random_points(64, box, random());
        for (int corner = 0; corner < 27; ++corner) {
            const vec3 share = vec3(corner % 3, corner / 3 % 3, corner / 9) * 0.5f;
            points.add(glm::clamp(box.low + share * (box.high - box.low), box.low, box.high));
        }
        const float bound = fractal_noise_bound(noise, turn, box);
        for (const float value : noise_at(noise, turn, points)) ASSERT_LE(value, bound) << i;
    }
}

TEST(NoiseBound, IsNeverTooSmall) { expect_no_violation(4000, 1); }
TEST(NoiseBound, NightlyIsNeverTooSmall) { expect_no_violation(200000, 2); }

TEST(NoiseBound, IsTightForBoxesBelowACell) {
    std::mt19937 random(5);
    double excess[3] = {};
    constexpr float widths[3] = {0.002f, 0.05f, 0.2f};
    for (int w = 0; w < 3; ++w) {
        for (int i = 0; i < 200; ++i) {
            const FractalNoise noise{.octaves = 1, .seed = static_cast<uint32_t>(i)};
            const vec3 low = vec3(random() % 1000, random() % 1000, random() % 1000) * 0.0173f;
            const Box box{low, low + widths[w]};
            const std::vector<float> values = noise_at(noise, 0, random_points(300, box, random()));
            excess[w] += (fractal_noise_bound(noise, 0, box) - *std::max_element(values.begin(), values.end())) / 200;
        }
    }
    EXPECT_LT(excess[0], 0.004);
    EXPECT_LT(excess[1], 0.04);
    EXPECT_LT(excess[2], 0.2);
}

TEST(NoiseBound, OfAWholeFieldIsItsPeak) {
    EXPECT_NEAR(fractal_noise_bound({}, 0, {vec3(-1000), vec3(1000)}), 1, 1e-4);
    EXPECT_NEAR(fractal_noise_bound({.billow = true}, 0, {vec3(-1000), vec3(1000)}), 1, 1e-4);
}

TEST(NoiseBound, WhatIsLeftOfASumIsNeverLessThanItsOctavesCanAdd) {
    const std::vector<NoiseLayer> layers{{.weight = 0.7f}, {.weight = 0.4f, .salt = 9}};
    for (const bool billow : {false, true}) {
        const NoiseSum sum = noise_sum({.octaves = 6, .gain = 0.6f, .billow = billow}, layers, dvec3(0));
        ASSERT_EQ(sum.octaves.size(), 12u);
        double left = 0;
        for (size_t k = sum.octaves.size(); k-- > 0;) {
            left += double{sum.octaves[k].scale} * std::sqrt(0.75);
            EXPECT_GE(sum.rest[k], left);
            EXPECT_LE(sum.rest[k], left * 1.001 + 2e-5);
        }
    }
}
}
}

#include "volume/noise/noise_fixtures.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

namespace tyndall::testing {
namespace {
const Box around_home{vec3(-20), vec3(20)};

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(Noise, EqualsTheSumWrittenOutPlainly) {
    const Points points = random_points(3000, around_home);
    for (const bool billow : {false, true})
        for (const float turn : {0.0f, 0.3f}) {
            const FractalNoise noise{
                .octaves = 6, .scale = 0.7f, .lacunarity = 2.13f, .gain = 0.6f, .seed = 77, .billow = billow};
            const NoiseSum sum = noise_sum(noise, {{.turn = wrapped_turn(snapped_turn(turn))}}, dvec3(0));
            const std::vector<float> values = noise_at(noise, turn, points);
            for (size_t i = 0; i < points.size(); ++i)
                ASSERT_NEAR(values[i], plain_sum(sum, dvec3(points.at(i))), 1e-5) << i;
        }
}

TEST(Noise, KeepsItsDigitsAMillionCellsAway) {
    Points points;
    for (const float far : {65536.0f, 1048576.0f, 4000000.0f})
        for (int i = 0; i < 500; ++i) points.add(vec3(far + i * 0.25f, 0.37f * i, -far + i * 0.5f));
    const FractalNoise noise{.octaves = 1, .scale = 1, .seed = 3};
    const NoiseSum sum = noise_sum(noise, {{}}, dvec3(0));
    const std::vector<float> values = noise_at(noise, 0, points);
    for (size_t i = 0; i < points.size(); ++i) {
        const double expected = plain_sum(sum, dvec3(points.at(i)));
        ASSERT_NEAR(values[i], expected, points.at(i).x < 2e6f ? 1e-3 : 0.2) << i;
    }
    EXPECT_GT(std_dev(values), 0.15);
}

TEST(Noise, IsFiniteAndBoundedWhereverItIsAsked) {
    Points points = random_points(2000, {vec3(-1e9f), vec3(1e9f)});
    for (const float v : {1e20f, -1e30f, 0.0f, -0.0f, 1e-40f}) points.add(vec3(v)), points.add(vec3(v, 0, 1));
    for (const bool billow : {false, true})
        for (const float value : noise_at({.octaves = 8, .scale = 0.01f, .billow = billow}, 0.2f, points)) {
            ASSERT_TRUE(std::isfinite(value));
            ASSERT_LE(std::abs(value), 1.0f);
        }
}

TEST(Noise, HasTheSpreadOfItsFormulaInEveryDirection) {
    const Points points = random_points(200000, {vec3(-400), vec3(400)});
    const std::vector<float> values = noise_at({.octaves = 1}, 0, points);
    // Independent unit gradients: variance is the mean over a cell of the sum of (weight · distance)² / 3.
    EXPECT_NEAR(mean_of(values), 0, 0.003);
    EXPECT_NEAR(std_dev(values), 0.19096 / noise_peak, 0.003);
    std::vector<float> sizes;
    for (const float v : values) sizes.push_back(std::abs(v) * noise_peak);
    EXPECT_NEAR(mean_of(sizes), noise_mean_size, 0.002);

    // A step along any direction changes it by as much: no grain along the axes at small distances.
    for (const vec3 way : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0.57735f), vec3(0.7071f, -0.7071f, 0)}) {
        Points moved;
        for (size_t i = 0; i < points.size(); ++i) moved.add(points.at(i) + way * 0.02f);
        const std::vector<float> other = noise_at({.octaves = 1}, 0, moved);
        double sum = 0;
        for (size_t i = 0; i < values.size(); ++i) sum += std::pow((other[i] - values[i]) / 0.02, 2);
        EXPECT_NEAR(std::sqrt(sum / values.size()) * noise_peak, noise_slope_spread, 0.02) << way.x << way.y << way.z;
    }
}

TEST(Noise, NeighboringGradientsHaveNothingInCommon) {
    // Values at the middle of cells a few cells apart, all 124 ways: 4 standard errors of 40 000 pairs.
    const FractalNoise noise{.octaves = 1, .seed = 9};
    const NoiseSum sum = noise_sum(noise, {{}}, dvec3(0));
    const vec3 middle = 0.5f - vec3(sum.octaves[0].fraction[0], sum.octaves[0].fraction[1], sum.octaves[0].fraction[2]);
    const auto grid = [&](ivec3 step) {
        Points points;
        for (int i = 0; i < 40000; ++i) points.add(middle + vec3(ivec3(i % 34, i / 34 % 34, i / 1156) * 3 + step));
        return noise_at(noise, 0, points);
    };
    const std::vector<float> home = grid(ivec3(0));
    double worst = 0;
    for (int i = 0; i < 125; ++i) {
        const ivec3 step = ivec3(i % 5, i / 5 % 5, i / 25) - 2;
        // Cells that share a face share half of their corners; those farther apart share none.
        if (glm::max(glm::abs(step.x), glm::max(glm::abs(step.y), glm::abs(step.z))) < 2) continue;
        worst = std::max(worst, std::abs(correlation(home, grid(step))));
    }
    EXPECT_LT(worst, 0.021);
}

TEST(Noise, OctavesDoNotVanishTogether) {
    // Gradient noise is 0 at its lattice points; shifted lattices do not share any.
    Points points;
    for (int i = 0; i < 4096; ++i) points.add(vec3(i % 16, i / 16 % 16, i / 256));
    const std::vector<float> values = noise_at({.octaves = 5}, 0, points);
    EXPECT_GT(std_dev(values), 0.08);
}

TEST(Noise, SeedsMakeUnrelatedFields) {
    const Points points = random_points(20000, around_home);
    const std::vector<float> first = noise_at({.seed = 1}, 0, points);
    for (const uint32_t seed : {0u, 2u, 3u, 0x80000001u})
        EXPECT_LT(std::abs(correlation(first, noise_at({.seed = seed}, 0, points))), 0.1) << seed;
}

TEST(Noise, AWholeTurnIsNoTurn) {
    const Points points = random_points(500, around_home);
    for (const float turn : {0.0f, 0.3f, 0.123f, 0.9999f})
        for (const float whole : {1.0f, -1.0f, 2.0f})
            EXPECT_TRUE(same_bits(noise_at({}, turn, points), noise_at({}, turn + whole, points))) << turn;
}

TEST(Noise, TurnsWithoutPulseAndWithoutMirror) {
    const Points points = random_points(120000, {vec3(-60), vec3(60)});
    const FractalNoise noise{.octaves = 3};
    const std::vector<float> start = noise_at(noise, 0, points);
    std::vector<float> before = start;
    for (int i = 1; i <= 16; ++i) {
        const std::vector<float> now = noise_at(noise, i / 16.0f, points);
        EXPECT_NEAR(std_dev(now) / std_dev(start), 1, 0.02) << i;
        EXPECT_GT(correlation(before, now), 0.3) << i;
        const double likeness = std::abs(correlation(start, now));
        EXPECT_LT(likeness, i > 1 && i < 15 ? 0.8 : 1.0001) << i;
        before = now;
    }
}

TEST(Noise, GivesTheSameBitsOnEveryInstructionSet) {
    if (!has_isa("avx512")) GTEST_SKIP() << "this machine has no AVX-512";
    Points points = random_points(10007, {vec3(-300), vec3(300)});
    for (int i = -40; i < 40; ++i) points.add(vec3(i)), points.add(vec3(i * 1e5f, 0, i * 0.125f));
    for (const bool billow : {false, true}) {
        const FractalNoise noise{.octaves = 7, .lacunarity = 1.93f, .seed = 1234567, .billow = billow};
        std::vector<float> wide, narrow;
        {
            const WithIsa isa("avx512");
            ASSERT_EQ(isa_name(), "avx512");
            wide = noise_at(noise, 0.37f, points);
        }
        {
            const WithIsa isa("avx2");
            ASSERT_EQ(isa_name(), "avx2");
            narrow = noise_at(noise, 0.37f, points);
        }
        EXPECT_TRUE(same_bits(wide, narrow));
    }
}

TEST(Noise, APointDoesNotDependOnItsNeighbors) {
    const Points points = random_points(100, around_home);
    const std::vector<float> together = noise_at({}, 0.1f, points);
    for (size_t i = 0; i < points.size(); ++i) {
        Points one;
        one.add(points.at(i));
        EXPECT_EQ(noise_at({}, 0.1f, one)[0], together[i]);
    }
}
}
}

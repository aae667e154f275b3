#include "base/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace tyndall {
namespace {
// Flipping one input bit flips each of 32 output bits with probability 1/2: 16 ± 2.8 of them. Over n pairs the mean
// lies within 5 standard errors of 16.
TEST(Random, MixAvalanches) {
    constexpr int inputs = 4000;
    for (uint32_t bit = 0; bit < 32; ++bit) {
        double flipped = 0;
        for (uint32_t i = 0; i < inputs; ++i)
            flipped += std::popcount(mix(i * 2654435761u) ^ mix(i * 2654435761u ^ 1u << bit));
        EXPECT_NEAR(flipped / inputs, 16, 5 * 2.83 / std::sqrt(inputs) + 0.05) << "bit " << bit;
    }
}

TEST(Random, MixNeverRepeats) {
    std::set<uint32_t> images;
    for (uint32_t i = 0; i < 100000; ++i) images.insert(mix(i));
    EXPECT_EQ(images.size(), 100000u); // a random function would repeat once with probability 0.69
}

TEST(Random, HashDependsOnEveryArgumentAndTheirOrder) {
    std::set<uint32_t> values;
    for (uint32_t a = 0; a < 8; ++a)
        for (uint32_t b = 0; b < 8; ++b)
            for (uint32_t c = 0; c < 8; ++c) values.insert(hash(a, b, c));
    EXPECT_EQ(values.size(), 512u);
    EXPECT_NE(hash(1u, 2u), hash(2u, 1u));
    EXPECT_NE(hash(1u), hash(1u, 0u));
}

TEST(Random, ValuesAreFixedForEver) {
    static_assert(mix(0) == 0);
    EXPECT_EQ(mix(1), 0x688990c0u);
    EXPECT_EQ(hash(1, 2, 3), 0xad1dea1fu);
    EXPECT_EQ(to_unit(0xffffffffu), 1 - 0x1p-24f);
    EXPECT_EQ(to_unit(0), 0.0f);
    EXPECT_EQ(reverse_bits(1), 1u << 31);
    EXPECT_EQ(reverse_bits(0x12345678u), 0x1e6a2c48u);
    const Sample2 early = sample2(5, 9), late = sample2(123456789, 77);
    EXPECT_EQ(early.x, 0x1.bd4ee2p-1f);
    EXPECT_EQ(early.y, 0x1.1d1388p-1f);
    EXPECT_EQ(late.x, 0x1.bd09eap-1f);
    EXPECT_EQ(late.y, 0x1.2bbf2cp-2f);
}

// Chi-square over 256 cells: mean 255, standard deviation 22.6; beyond 5 deviations it is not uniform.
TEST(Random, UnitNumbersAreUniformInEveryArgument) {
    for (int argument = 0; argument < 4; ++argument) {
        std::vector<int> cells(256);
        constexpr int draws = 1 << 16;
        for (uint32_t i = 0; i < draws; ++i) {
            uint32_t a[4] = {7, 3, 1, 9};
            a[argument] = i;
            const float value = random_unit(a[0], a[1], a[2], a[3]);
            ASSERT_GE(value, 0.0f);
            ASSERT_LT(value, 1.0f);
            ++cells[static_cast<size_t>(value * 256)];
        }
        double chi_square = 0;
        for (const int count : cells) chi_square += (count - draws / 256.0) * (count - draws / 256.0) / (draws / 256.0);
        EXPECT_NEAR(chi_square, 255, 5 * 22.6) << "argument " << argument;
    }
}

// A (0,2)-sequence: every aligned run of 2^m samples has one in each of the 2^m boxes of every shape 2^-a x 2^-(m-a).
TEST(Random, Sample2StratifiesEveryElementaryInterval) {
    for (const uint32_t seed : {0u, 1u, 12345u, 0xdeadbeefu}) {
        for (uint32_t m = 1; m <= 8; ++m) {
            for (uint32_t run = 0; run < 5; ++run) {
                for (uint32_t a = 0; a <= m; ++a) {
                    std::vector<int> hits(1u << m);
                    for (uint32_t i = 0; i < 1u << m; ++i) {
                        const Sample2 s = sample2((run << m) + i, seed);
                        const auto column = static_cast<uint32_t>(s.x * static_cast<float>(1u << a));
                        const auto row = static_cast<uint32_t>(s.y * static_cast<float>(1u << (m - a)));
                        ++hits[(row << a) + column];
                    }
                    for (const int count : hits)
                        ASSERT_EQ(count, 1) << "seed " << seed << ", 2^" << m << ", run " << run << ", shape " << a;
                }
            }
        }
    }
}

// Independent uniform numbers have correlation 0 ± 1/sqrt(n).
TEST(Random, SeedsDecorrelate) {
    constexpr int draws = 20000;
    double xx = 0, yy = 0, xy = 0;
    for (uint32_t seed = 0; seed < draws; ++seed) {
        const Sample2 a = sample2(3, seed), b = sample2(3, seed + 1);
        xx += (a.x - 0.5) * (b.x - 0.5), yy += (a.y - 0.5) * (b.y - 0.5), xy += (a.x - 0.5) * (a.y - 0.5);
    }
    for (const double sum : {xx, yy, xy}) EXPECT_NEAR(12 * sum / draws, 0, 5 / std::sqrt(draws));
}

// Owen scrambling keeps each sample uniform: over seeds, mean 1/2 and variance 1/12.
TEST(Random, EverySampleIsUniformOverSeeds) {
    constexpr int seeds = 20000;
    for (const uint32_t index : {0u, 1u, 15u, 1000u}) {
        double x = 0, y = 0, square = 0;
        for (uint32_t seed = 0; seed < seeds; ++seed) {
            const Sample2 s = sample2(index, hash(seed));
            x += s.x, y += s.y, square += (s.x - 0.5) * (s.x - 0.5);
        }
        EXPECT_NEAR(x / seeds, 0.5, 5 * 0.2887 / std::sqrt(seeds)) << index;
        EXPECT_NEAR(y / seeds, 0.5, 5 * 0.2887 / std::sqrt(seeds)) << index;
        EXPECT_NEAR(square / seeds, 1.0 / 12, 5 * 0.0745 / std::sqrt(seeds)) << index;
    }
}
}
}

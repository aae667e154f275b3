// Patterns of jitter: even in number, and blue where they say so.
#include "trace/sampling/jitter.h"

#include <gtest/gtest.h>

#include <complex>
#include <set>
#include <vector>

namespace tyndall {
namespace {
constexpr int side = 64;

std::vector<double> tile(Jitter jitter, int frame) {
    std::vector<double> values;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) values.push_back(jitter_bits(jitter, {x, y}, frame, 5) * 0x1p-32);
    return values;
}

// Power of all frequencies below `radius` cycles a tile, as a share of what white noise has.
double low_power(const std::vector<double>& values, int radius) {
    double power = 0, mean = 0, variance = 0;
    for (const double value : values) mean += value / values.size();
    for (const double value : values) variance += (value - mean) * (value - mean) / values.size();
    int count = 0;
    for (int v = -radius; v <= radius; ++v)
        for (int u = -radius; u <= radius; ++u) {
            if ((u == 0 && v == 0) || u * u + v * v > radius * radius) continue;
            std::complex<double> sum = 0;
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x)
                    sum += (values[y * side + x] - mean) * std::polar(1.0, -2 * double(pi) * (u * x + v * y) / side);
            power += std::norm(sum), ++count;
        }
    return power / count / (variance * static_cast<double>(values.size()));
}

TEST(Jitter, EveryPatternIsEvenlySpread) {
    for (const Jitter jitter :
         {Jitter::ordered, Jitter::white, Jitter::blue, Jitter::interleaved, Jitter::spatiotemporal})
        for (const int frame : {0, 1, 7}) {
            double sum = 0;
            std::vector<int> counts(16);
            for (const double value : tile(jitter, frame)) sum += value, ++counts.at(static_cast<size_t>(value * 16));
            EXPECT_NEAR(sum / (side * side), 0.5, 4 * 0.289 / side) << static_cast<int>(jitter);
            for (const int count : counts) EXPECT_NEAR(count, 256, 4 * 16) << static_cast<int>(jitter);
        }
    EXPECT_EQ(jitter_bits(Jitter::none, {3, 4}, 9, 1), 0x80000000u);
}

TEST(Jitter, OrderedRepeatsAfterFourPixelsAndHoldsSixteenLevels) {
    std::set<uint32_t> levels;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            levels.insert(jitter_bits(Jitter::ordered, {x, y}, 0, 0));
            EXPECT_EQ(jitter_bits(Jitter::ordered, {x, y}, 3, 0), jitter_bits(Jitter::ordered, {x + 8, y + 4}, 3, 0));
        }
    EXPECT_EQ(levels.size(), 16u);
}

TEST(Jitter, BlueNoiseHasNoLowFrequencies) {
    EXPECT_NEAR(low_power(tile(Jitter::white, 0), 8), 1, 0.3);
    EXPECT_LT(low_power(tile(Jitter::blue, 0), 8), 0.03);
    EXPECT_LT(low_power(tile(Jitter::spatiotemporal, 3), 8), 0.1);
}

// The mean of four frames of a pixel comes nearer to ½ than with white noise.
TEST(Jitter, SpatiotemporalNoiseIsBlueInTime) {
    const auto spread = [](Jitter jitter) {
        double squares = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                double mean = 0;
                for (int frame = 0; frame < 4; ++frame) mean += jitter_bits(jitter, {x, y}, frame, 0) * 0x1p-34;
                squares += (mean - 0.5) * (mean - 0.5) / (side * side);
            }
        return std::sqrt(squares);
    };
    EXPECT_NEAR(spread(Jitter::white), std::sqrt(1.0 / 48), 0.01);
    EXPECT_LT(spread(Jitter::spatiotemporal), 0.75 * spread(Jitter::white));
}
}
}

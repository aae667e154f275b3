// Noise is taken out of grids of fluence, light is not.
#include "base/random.h"
#include "trace/fluence/smoothing.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr int side = 32;

// Of cells whose twelve numbers are alike.
FluenceGrid grid_of(const auto& value) {
    FluenceGrid grid;
    grid.size = ivec3(side);
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z) grid.values.insert(grid.values.end(), 12, value(ivec3(x, y, z)));
    return grid;
}

// Adds noise of so much power, and returns what two halves that make it are apart.
std::vector<float> add_noise(float power, uint32_t seed, FluenceGrid& grid) {
    std::vector<float> difference;
    for (size_t i = 0; i < grid.values.size(); ++i) {
        const auto half = [&](uint32_t which) {
            return std::sqrt(12 * 2 * power) * (random_unit(static_cast<uint32_t>(i), which, 0, seed) - 0.5f);
        };
        const float one = half(0), other = half(1);
        grid.values[i] += (one + other) / 2;
        difference.push_back((one - other) / 2);
    }
    return difference;
}

double power_between(const FluenceGrid& a, const FluenceGrid& b) {
    double sum = 0;
    for (size_t i = 0; i < a.values.size(); ++i) sum += std::pow(double{a.values[i]} - b.values[i], 2);
    return sum / static_cast<double>(a.values.size());
}

float beam(ivec3 cell) { return cell.x == side / 2 && cell.y == side / 2 ? 50.0f : 1.0f; }

double sum_of(const FluenceGrid& grid) {
    double sum = 0;
    for (const float value : grid.values) sum += value;
    return sum;
}
}

// A mean of the whole grid would be as good as can be; each filter leaves at most an eighth, and its power has errors.
TEST(FluenceSmoothing, LeavesLittleNoiseOfEvenLight) {
    for (const uint32_t seed : {1u, 2u, 3u}) {
        const FluenceGrid even = grid_of([](ivec3) { return 1.0f; });
        FluenceGrid grid = even;
        const std::vector<float> difference = add_noise(0.04f, seed, grid);
        ASSERT_NEAR(power_between(grid, even), 0.04, 0.001);
        smooth(difference, grid);
        EXPECT_LT(power_between(grid, even), 0.04 / 30) << seed;
    }
}

TEST(FluenceSmoothing, LeavesLightAsItIsWhereThereIsNoNoise) {
    const FluenceGrid sharp = grid_of(beam);
    FluenceGrid grid = sharp;
    smooth(std::vector<float>(grid.values.size(), 0.0f), grid);
    EXPECT_LT(power_between(grid, sharp), 1e-10);
}

// A beam of one cell's width in noise: what makes it out stays, and far from it there is as little noise as in even
// light.
TEST(FluenceSmoothing, KeepsABeamAndTakesTheNoiseBesideIt) {
    const FluenceGrid sharp = grid_of(beam);
    FluenceGrid grid = sharp;
    const std::vector<float> difference = add_noise(0.04f, 4, grid);
    smooth(difference, grid);
    const auto at = [&](const FluenceGrid& of, ivec3 cell) { return double{of.values[12 * cell_index(of, cell)]}; };
    double beside = 0;
    for (int z = 0; z < side; ++z) {
        EXPECT_NEAR(at(grid, {side / 2, side / 2, z}), 50, 1);
        for (int y = 0; y < side; ++y) beside += std::pow(at(grid, {0, y, z}) - 1, 2) / (side * side);
    }
    EXPECT_LT(beside, 0.04 / 10);
}

// Half of the grid is dark and lies behind a wall. There is nothing but noise, of which no detail of single cells
// stays.
TEST(FluenceSmoothing, NothingPassesAWallAndNoLightIsLost) {
    const FluenceGrid halves = grid_of([](ivec3 cell) { return cell.y < 11 ? 1.0f : 0.0f; });
    FluenceGrid grid = halves;
    grid.walls.assign(grid.values.size() / 12, 0);
    for (int x = 0; x < side; ++x)
        for (int z = 0; z < side; ++z) grid.walls[cell_index(grid, {x, 10, z})] = 1 << 1;
    // One cell in a hundred holds all light of its side, by one half or by the other.
    std::vector<float> difference(grid.values.size(), 0.0f);
    for (size_t cell = 0; cell < grid.values.size() / 12; ++cell) {
        const bool lit = halves.values[12 * cell] > 0 && random_unit(static_cast<uint32_t>(cell), 0, 0, 7) < 0.01f;
        const float sign = random_unit(static_cast<uint32_t>(cell), 1, 0, 7) < 0.5f ? 1.0f : -1.0f;
        for (size_t i = 12 * cell; i < 12 * cell + 12; ++i)
            grid.values[i] = lit ? 100.0f : 0.0f, difference[i] = sign * grid.values[i];
    }
    const double before = sum_of(grid);
    smooth(difference, grid);
    EXPECT_NEAR(sum_of(grid) / before, 1, 0.02);
    double largest = 0;
    for (size_t i = 0; i < grid.values.size(); ++i) {
        EXPECT_GE(grid.values[i], -1e-4f);
        if (halves.values[i] == 0) {
            EXPECT_EQ(grid.values[i], 0) << "behind the wall";
        }
        largest = std::max(largest, double{grid.values[i]});
    }
    EXPECT_LT(largest, 2 * 100 / 8.0) << "the narrowest filter leaves an eighth of a cell, and two may touch";
}

TEST(FluenceSmoothing, OneCellStaysWhatItIs) {
    FluenceGrid grid;
    grid.size = ivec3(1), grid.values.assign(12, 3);
    smooth(std::vector<float>(12, 3), grid);
    for (const float value : grid.values) EXPECT_EQ(value, 3);
}
}

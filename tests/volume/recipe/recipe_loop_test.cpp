#include "volume/recipe/recipe_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall::testing {
namespace {
TEST(RecipeLoop, RepeatsToTheLastBit) {
    const Points points = random_points(3000, {vec3(-3, -1, -2), vec3(3, 2, 2)});
    for (const double period : {4.0, 1.0, 2.5, 7.0 / 3.0}) {
        FogRecipe recipe = busy_fog();
        recipe.period = period;
        for (const double start : {0.0, 0.7, period * 0.999})
            for (const double loops : {1.0, -1.0, 3.0})
                EXPECT_EQ(density_at(recipe, start, points), density_at(recipe, start + loops * period, points))
                    << period << " from " << start;
    }
}

TEST(RecipeLoop, FramesRepeatAtEveryFrameRate) {
    const Points points = random_points(300, {vec3(-3, -1, -2), vec3(3, 2, 2)});
    for (const double rate : {24.0, 25.0, 30.0, 24000.0 / 1001}) {
        FogRecipe recipe = busy_fog();
        const int frames = 96;
        recipe.period = frames / rate;
        for (int frame = 0; frame < frames; frame += 5)
            EXPECT_EQ(density_at(recipe, frame / rate, points), density_at(recipe, (frame + 2 * frames) / rate, points))
                << frame << " at " << rate;
    }
}

TEST(RecipeLoop, ChangesAllTheTimeAndNeverJumps) {
    FogRecipe recipe = busy_fog();
    recipe.height_falloff = 0, recipe.threshold = 0.3f, recipe.gain = 1.5f;
    const Points points = random_points(4000, {vec3(-2.5f, -0.5f, -1.5f), vec3(2.5f, 1.5f, 1.5f)});
    constexpr int frames = 96;
    std::vector<double> steps;
    std::vector<float> before = density_at(recipe, 0, points);
    for (int frame = 1; frame <= frames; ++frame) {
        const std::vector<float> now = density_at(recipe, frame * recipe.period / frames, points);
        double sum = 0;
        for (size_t i = 0; i < now.size(); ++i) sum += std::abs(now[i] - before[i]);
        steps.push_back(sum / now.size());
        before = now;
    }
    const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
    EXPECT_GT(*least, 0.003);
    EXPECT_LT(*most, 2 * *least) << "the seam, if there were one, would stand out";
}

TEST(RecipeLoop, KeepsItsContrast) {
    // All of the noise, unclamped, over some ten thousand cells.
    FogRecipe recipe;
    recipe.bounds = {vec3(-12), vec3(12)};
    recipe.noise = {.octaves = 3, .scale = 1, .seed = 4, .evolve = 0.25f};
    recipe.threshold = 0, recipe.gain = 1;
    recipe.wind = vec3(0.3f, 0.05f, 0.1f), recipe.swirl = 0.1f, recipe.swirl_speed = 0.2f, recipe.period = 4;
    const Points points = random_points(60000, recipe.bounds);
    for (const bool billow : {false, true}) {
        recipe.noise.billow = billow;
        std::vector<double> means, spreads;
        for (int i = 0; i < 16; ++i) {
            const std::vector<float> density = density_at(recipe, i / 4.0, points);
            means.push_back(mean_of(density)), spreads.push_back(std_dev(density));
        }
        double mean = 0, spread = 0;
        for (size_t i = 0; i < spreads.size(); ++i) mean += means[i] / 16, spread += spreads[i] / 16;
        for (size_t i = 0; i < spreads.size(); ++i) {
            EXPECT_NEAR(spreads[i] / spread, 1, 0.02) << i << (billow ? " billow" : "");
            EXPECT_NEAR(means[i], mean, 0.1 * spread) << i << (billow ? " billow" : "");
        }
    }
}

TEST(RecipeLoop, WindKeepsItsSpeed) {
    // Fog looks most like itself a moment ago where the wind has throughput it.
    FogRecipe recipe;
    recipe.bounds = {vec3(-10), vec3(10)};
    recipe.noise = {.octaves = 3, .scale = 1};
    recipe.threshold = 0, recipe.gain = 1, recipe.period = 4;
    recipe.wind = vec3(0.31f, 0, 0.11f);
    const Points points = random_points(20000, {vec3(-8), vec3(8)});
    for (const double now : {0.0, 0.9, 2.0, 3.1}) {
        const std::vector<float> before = density_at(recipe, now, points);
        double best = -1;
        float best_speed = 0;
        for (float speed = 0; speed <= 2; speed += 0.1f) {
            Points there;
            for (size_t i = 0; i < points.size(); ++i) there.add(points.at(i) + recipe.wind * (speed * 0.4f));
            const double likeness = correlation(before, density_at(recipe, now + 0.4, there));
            if (likeness > best) best = likeness, best_speed = speed;
        }
        EXPECT_NEAR(best_speed, 1, 0.11) << now;
        EXPECT_GT(best, 0.75) << now;
    }
}

TEST(RecipeLoop, RoundsTurnsToWholeOnes) {
    FogRecipe recipe;
    recipe.period = 4;
    EXPECT_EQ(turns_per_loop(recipe, 0), 0);
    EXPECT_EQ(turns_per_loop(recipe, 0.01), 1);
    EXPECT_EQ(turns_per_loop(recipe, 0.3), 1);
    EXPECT_EQ(turns_per_loop(recipe, 0.5), 2);
    EXPECT_EQ(turns_per_loop(recipe, -0.4), -2);
}
}
}

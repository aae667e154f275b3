// A recipe's fire against its formula, its smoke, and what neither may do: end at a leaf, jump at the seam.
#include "volume/recipe/recipe_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall::testing {
namespace {
std::vector<float> kelvin_at(const FogRecipe& recipe, double seconds, const Points& points) {
    std::vector<float> values(points.size());
    recipe_temperature(recipe, seconds, points.x, points.y, points.z, values);
    return values;
}

// Flames of 0.8 m without smoke.
FogRecipe torch() {
    FogRecipe recipe;
    recipe.bounds = {vec3(-1, -0.5f, -1), vec3(1, 2, 1)};
    recipe.voxel_size = 0.03125;
    recipe.threshold = 1;
    recipe.fire = FireRecipe{.base = vec3(0.1f, 0.2f, -0.1f), .height = 0.8f, .radius = 0.3f, .taper = 1.5f};
    return recipe;
}

FogRecipe busy_fire(uint32_t seed) {
    FogRecipe recipe = torch();
    recipe.threshold = 0.4f;
    recipe.wind = vec3(0.2f, 0.5f, 0);
    recipe.swirl = 0.05f, recipe.swirl_scale = 0.5f, recipe.swirl_speed = 0.3f;
    recipe.noise = {.octaves = 3, .scale = 0.4f, .seed = seed};
    recipe.fire->noise.seed = seed, recipe.fire->flicker = 0.7f, recipe.fire->noise.billow = seed % 2 == 0;
    return recipe;
}

double still_heat(const FireRecipe& fire, dvec3 point) {
    const dvec3 p = point - dvec3(fire.base);
    const double h = std::max(p.y, 0.0) / fire.height, below = std::min(p.y, 0.0) / fire.radius;
    const double r = std::hypot(p.x, p.z) / fire.radius, wide = 1 + fire.taper * h;
    return 1 - h * h - 16 * below * below - r * r * wide * wide;
}

TEST(Fire, StillFlamesHaveTheHeatOfTheFormula) {
    FogRecipe recipe = torch();
    FireRecipe& fire = *recipe.fire;
    fire.flicker = 0, fire.soot = 0.25f;
    Points points = random_points(20000, {vec3(-0.3f, 0, -0.5f), vec3(0.5f, 1.1f, 0.3f)});
    points.add(fire.base);
    const std::vector<float> kelvin = kelvin_at(recipe, 1, points), density = density_at(recipe, 1, points);
    int flames = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const double heat = still_heat(fire, dvec3(points.at(i)));
        if (std::abs(heat) < 1e-5) continue;
        ASSERT_NEAR(kelvin[i], heat > 0 ? 1100 + 800 * heat : 0, 0.01) << i;
        ASSERT_NEAR(density[i], heat > 0 && 0.25 * heat >= min_density ? 0.25 * heat : 0, 2e-6) << i;
        flames += heat > 0;
    }
    EXPECT_GT(flames, 2000);
    EXPECT_LT(flames, 15000);
    EXPECT_NEAR(kelvin.back(), 1900, 1e-3) << "the core at the base";

    // The tip of the axis and the rim of the base, a millimeter to both sides.
    Points ends;
    for (const float d : {-1e-3f, 1e-3f})
        ends.add(fire.base + vec3(0, fire.height + d, 0)), ends.add(fire.base + vec3(fire.radius + d, 0, 0));
    const std::vector<float> there = kelvin_at(recipe, 1, ends);
    for (const int i : {0, 1}) EXPECT_NEAR(there[i], 1100, 7) << i;
    for (const int i : {2, 3}) EXPECT_EQ(there[i], 0) << i;
}

TEST(Fire, FlickerAddsNoiseThatRises) {
    // Where heat is between 0 and 1 the noise can be had back from it, and a moment later a little higher.
    FogRecipe recipe = torch();
    recipe.bounds = {vec3(-1, -0.5f, -1), vec3(1, 4, 1)};
    FireRecipe& fire = *recipe.fire;
    fire.flicker = 0.3f, fire.rise = 1.5f, fire.stretch = 2.5f;
    const auto noise_at_points = [&](double seconds, const Points& points) {
        std::vector<double> noise;
        const std::vector<float> kelvin = kelvin_at(recipe, seconds, points);
        for (size_t i = 0; i < points.size(); ++i) {
            const double heat = (kelvin[i] - 1100.0) / 800, h = (points.y[i] - fire.base.y) / fire.height;
            const double t = glm::clamp(h / 0.5, 0.0, 1.0), onset = t * t * (3 - 2 * t);
            const double gain = 4 * fire.flicker * (0.25 + 0.75 * onset);
            const bool known = heat > 1e-3 && heat < 1 - 1e-3;
            noise.push_back(known ? (heat - still_heat(fire, dvec3(points.at(i)))) / gain : 9);
        }
        return noise;
    };
    const Points here = random_points(20000, {vec3(-0.2f, 0.3f, -0.4f), vec3(0.4f, 0.8f, 0.2f)});
    Points there;
    const double later = 0.1;
    for (size_t i = 0; i < here.size(); ++i) there.add(here.at(i) + vec3(0, fire.rise * later, 0));
    const std::vector<double> before = noise_at_points(2, here), after = noise_at_points(2 + later, there);
    int compared = 0;
    double spread = 0;
    for (size_t i = 0; i < before.size(); ++i) {
        if (before[i] == 9 || after[i] == 9) continue;
        ASSERT_NEAR(before[i], after[i], 2e-4) << i;
        ++compared, spread += before[i] * before[i];
    }
    EXPECT_GT(compared, 2000);
    EXPECT_GT(std::sqrt(spread / compared), 0.08) << "no noise at all";
}

TEST(Fire, SmokeFillsAPlume) {
    FogRecipe recipe = torch();
    FireRecipe& fire = *recipe.fire;
    recipe.threshold = 0, recipe.gain = 1000; // smoke without wisps
    fire.flicker = 0, fire.soot = 0, fire.smoke_start = 0.5f, fire.smoke_spread = 0.25f, fire.air = 400;
    const Points points = random_points(20000, recipe.bounds);
    const std::vector<float> density = density_at(recipe, 0, points), kelvin = kelvin_at(recipe, 0, points);
    const auto smoothstep = [](double t) {
        t = glm::clamp(t, 0.0, 1.0);
        return t * t * (3 - 2 * t);
    };
    for (size_t i = 0; i < points.size(); ++i) {
        const dvec3 p = dvec3(points.at(i)) - dvec3(fire.base);
        const double radius = 0.3 + 0.25 * std::max(p.y, 0.0), share = (p.x * p.x + p.z * p.z) / (radius * radius);
        const double expected = smoothstep((p.y - 0.4) / 0.4) * smoothstep(1 - share);
        ASSERT_NEAR(density[i], expected < min_density ? 0 : expected, 2e-5) << i;
        if (still_heat(fire, dvec3(points.at(i))) < 0) {
            ASSERT_EQ(kelvin[i], density[i] > 0 ? 400 : 0) << i;
        }
    }
}

TEST(Fire, LoopsToTheLastBit) {
    const Points points = random_points(3000, {vec3(-0.5f, 0, -0.5f), vec3(0.5f, 1.5f, 0.5f)});
    for (const double period : {2.0, 7.0 / 3.0}) {
        FogRecipe recipe = busy_fire(3);
        recipe.period = period;
        for (const double start : {0.0, 0.7, period * 0.999}) {
            const std::vector<float> kelvin = kelvin_at(recipe, start, points);
            EXPECT_EQ(kelvin, kelvin_at(recipe, start + period, points)) << start;
            EXPECT_EQ(density_at(recipe, start, points), density_at(recipe, start - 2 * period, points)) << start;
            EXPECT_NE(kelvin, kelvin_at(recipe, start + period / 2, points)) << start;
        }
    }
}

TEST(Fire, GrowsEveryVoxelOfFlameAndSmoke) {
    for (uint32_t seed = 0; seed < 6; ++seed) {
        FogRecipe recipe = busy_fire(seed);
        if (seed == 5) { // leaves much smaller than a tongue, alone: nothing but the bound of the noise decides
            recipe.swirl = 0, recipe.threshold = 1, recipe.voxel_size = 0.015625;
            recipe.bounds = {vec3(-0.5f, 0, -0.5f), vec3(0.5f, 1.5f, 0.5f)};
        }
        const ivec3 size = ivec3(glm::ceil(recipe.bounds.size() / static_cast<float>(recipe.voxel_size) - 0.5f));
        Points points;
        for (int x = 0; x < size.x; ++x)
            for (int y = 0; y < size.y; ++y)
                for (int z = 0; z < size.z; ++z)
                    points.add(dvec3(recipe.bounds.low) + (dvec3(x, y, z) + 0.5) * recipe.voxel_size);
        const double seconds = 0.3 * seed;
        const auto expect_all = [&](const SparseVolume& volume, const std::vector<float>& expected) {
            std::vector<float> grown(expected.size());
            for (const Leaf& leaf : volume.leaves)
                for (int v = 0; v < 512; ++v) {
                    const ivec3 at = leaf.origin + ivec3(v / 64, v / 8 % 8, v % 8);
                    if (glm::all(glm::lessThan(at, size)))
                        grown[(size_t(at.x) * size.y + at.y) * size.z + at.z] = leaf.values[v];
                    else
                        EXPECT_EQ(leaf.values[v], 0) << "outside the bounds";
                }
            EXPECT_TRUE(grown == expected) << seed;
            EXPECT_LT(volume.leaves.size() * 512, expected.size() * 3 / 4) << "hardly any empty leaf was tested";
        };
        GenerateReport report;
        expect_all(generate(recipe, seconds, &report), density_at(recipe, seconds, points));
        expect_all(generate_temperature(recipe, seconds), kelvin_at(recipe, seconds, points));
        EXPECT_LE(report.kept, report.tried);
    }
    EXPECT_TRUE(generate_temperature(full_fog(), 0).empty());
}

TEST(Fire, WithoutOneNothingHasATemperature) {
    const Points points = random_points(100, full_fog().bounds);
    EXPECT_EQ(kelvin_at(full_fog(), 0, points), std::vector<float>(points.size()));
}

// Speeds at points, all of smoke or all of flame.
std::vector<vec3> velocities(const FogRecipe& recipe, double seconds, const std::vector<vec3>& points, bool flame) {
    const std::vector<float> kelvin(points.size(), flame ? 1500.0f : 300.0f);
    std::vector<vec3> result(points.size());
    recipe_velocity(recipe, seconds, points, kelvin, result);
    return result;
}

std::vector<vec3> points_of(const Box& box, int count) {
    const Points random = random_points(count, box);
    std::vector<vec3> points;
    for (size_t i = 0; i < random.size(); ++i) points.push_back(random.at(i));
    return points;
}

TEST(FireVelocity, IsThatOfTheCarriageWhereNothingSwirls) {
    FogRecipe recipe = busy_fire(1);
    recipe.swirl = 0;
    const std::vector<vec3> points = points_of(recipe.bounds, 50);
    for (const vec3 v : velocities(recipe, 1, points, false)) EXPECT_EQ(v, recipe.wind);
    for (const vec3 v : velocities(recipe, 1, points, true)) EXPECT_EQ(v, vec3(0, recipe.fire->rise, 0));
    recipe.fire.reset();
    for (const vec3 v : velocities(recipe, 1, points, true)) EXPECT_EQ(v, recipe.wind);
}

TEST(FireVelocity, FollowsWhatTheNoiseShows) {
    // Of smoke the noise at p shows the place p + D(p, t) - wind t of a lattice at rest: moving along keeps it. The
    // swirl's own motion is as large as the wind here, and its bends change what either does by half.
    FogRecipe recipe = busy_fire(1);
    recipe.swirl = 0.06f, recipe.swirl_scale = 0.4f, recipe.swirl_speed = 1;
    const std::vector<vec3> points = points_of(recipe.bounds, 2000);
    const double seconds = 0.4, step = 1e-3;
    const std::vector<vec3> speeds = velocities(recipe, seconds, points, false);
    const auto places = [&](double sign) {
        std::vector<vec3> moved, swirl(points.size());
        for (size_t i = 0; i < points.size(); ++i)
            moved.push_back(points[i] + static_cast<float>(sign * step) * speeds[i]);
        recipe_swirl(recipe, seconds + sign * step, moved, swirl);
        std::vector<dvec3> result;
        for (size_t i = 0; i < points.size(); ++i)
            result.push_back(dvec3(moved[i]) + dvec3(swirl[i]) - dvec3(recipe.wind) * (seconds + sign * step));
        return result;
    };
    const std::vector<dvec3> before = places(-1), after = places(1);
    int good = 0;
    double plain = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const double drift = glm::distance(before[i], after[i]) / (2 * step);
        good += drift < 0.01;
        plain += glm::distance(speeds[i], recipe.wind) / static_cast<double>(points.size());
    }
    EXPECT_GT(good, 1900) << "but where space is folded";
    EXPECT_GT(plain, 0.2) << "meters per second by the swirl";
}

TEST(FireVelocity, FlamesAreBentFromTheirFeetUp) {
    FogRecipe recipe = busy_fire(1);
    const FireRecipe& fire = *recipe.fire;
    const auto at = [&](float height) {
        return velocities(recipe, 0.3, {fire.base + vec3(0.05f, height * fire.height, 0)}, true)[0];
    };
    EXPECT_LT(glm::distance(at(0), vec3(0, fire.rise, 0)), 0.01f * fire.rise); // by differences a cell/100 wide
    EXPECT_GT(glm::distance(at(0.6f), vec3(0, fire.rise, 0)), 0.05f);
}
}
}

#include "volume/recipe/recipe_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall::testing {
namespace {
float smoothstep(float t) {
    t = glm::clamp(t, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

TEST(RecipeDensity, IsTheRemapOfTheNoise) {
    FogRecipe recipe;
    recipe.bounds = {vec3(-4), vec3(4)};
    recipe.noise = {.octaves = 4, .scale = 0.8f, .seed = 21};
    recipe.threshold = 0.45f, recipe.gain = 5, recipe.soft_edge = 0.04f;
    const Points points = random_points(5000, {vec3(-4), vec3(4)});
    const std::vector<float> density = density_at(recipe, 0, points), noise = noise_at(recipe.noise, 0, points);
    int clear = 0, full = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const float above = (noise[i] + 1) / 2 - recipe.threshold;
        const float expected = glm::clamp(above * recipe.gain, 0.0f, 1.0f) * smoothstep(above / recipe.soft_edge);
        ASSERT_NEAR(density[i], expected < min_density ? 0 : expected, 1e-4) << i;
        clear += density[i] == 0, full += density[i] == 1;
    }
    EXPECT_GT(clear, 100);
    EXPECT_GT(full, 10);
}

TEST(RecipeDensity, SoftEdgeStartsWithoutAKink) {
    // The density as a function of the noise alone: raise the threshold past a fixed point.
    Points point;
    point.add(vec3(0.3f));
    FogRecipe recipe;
    recipe.noise.octaves = 1, recipe.gain = 1, recipe.soft_edge = 0.1f;
    const float noise01 = (noise_at(recipe.noise, 0, point)[0] + 1) / 2;
    const auto at = [&](float above) {
        recipe.threshold = noise01 - above;
        return density_at(recipe, 0, point)[0];
    };
    constexpr float step = 1e-3f;
    float slope_before = 0;
    for (float above = -0.02f; above < 0.15f; above += step) {
        const float slope = (at(above + step) - at(above)) / step;
        EXPECT_NEAR(slope, slope_before, 0.08f) << above;
        slope_before = slope;
    }
    EXPECT_NEAR(slope_before, 1, 0.01);
}

TEST(RecipeDensity, FallsOffWithHeightAsAsked) {
    FogRecipe recipe = full_fog();
    recipe.height_base = 0.5f, recipe.height_falloff = 0.3f;
    Points points;
    for (int i = 0; i <= 40; ++i) points.add(vec3(0.7f, i * 0.05f, 0.1f));
    const std::vector<float> density = density_at(recipe, 0, points);
    for (size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(density[i], std::exp(-std::max(points.y[i] - 0.5f, 0.0f) / 0.3f), 2e-6) << points.y[i];
}

TEST(RecipeDensity, FadesAtTheBorderAndEndsAtTheBounds) {
    FogRecipe recipe = full_fog();
    recipe.border = vec3(0.5f, 0, 0.25f);
    const Points points = random_points(4000, {vec3(-1.5f, -0.5f, -2.5f), vec3(3.5f, 2.5f, 2.5f)});
    const std::vector<float> density = density_at(recipe, 0, points);
    for (size_t i = 0; i < points.size(); ++i) {
        const vec3 p = points.at(i);
        const vec3 inside = glm::min(p - recipe.bounds.low, recipe.bounds.high - p);
        const bool in = inside.x >= 0 && inside.y >= 0 && inside.z >= 0;
        const float expected = in ? smoothstep(inside.x / 0.5f) * smoothstep(inside.z / 0.25f) : 0;
        ASSERT_NEAR(density[i], expected < min_density ? 0 : expected, 1e-5) << i;
    }
}

TEST(RecipeDensity, AnEllipsoidFillsItsBoundsAndNoMore) {
    FogRecipe recipe = full_fog();
    recipe.shape = FogShape::ellipsoid, recipe.shape_strength = 0, recipe.shape_level = 0.25f;
    const Points points = random_points(4000, recipe.bounds);
    const std::vector<float> density = density_at(recipe, 0, points);
    for (size_t i = 0; i < points.size(); ++i) {
        const vec3 p = points.at(i) - vec3(1, 0.5f, 0);
        const vec3 share = p / vec3(2, p.y < 0 ? 0.5f : 1.5f, 2);
        const float expected = smoothstep((1 - glm::dot(share, share)) * 5);
        ASSERT_NEAR(density[i], expected < min_density ? 0 : expected, 2e-5) << i;
    }
    // Strength moves the threshold: all fog in the middle, none near the surface.
    recipe.threshold = 0.5f, recipe.shape_strength = 0.5f;
    Points middle, outer;
    middle.add(vec3(1, 0.5f, 0)), outer.add(vec3(1, 0.5f, 1.99f)), outer.add(vec3(2.95f, 0.5f, 0));
    EXPECT_GT(density_at(recipe, 0, middle)[0], 0.9f);
    for (const float value : density_at(recipe, 0, outer)) EXPECT_EQ(value, 0);
}

TEST(RecipeDensity, WindCarriesTheFog) {
    FogRecipe recipe;
    recipe.bounds = {vec3(-1000), vec3(1000)};
    recipe.wind = vec3(0.5f, -0.25f, 1);
    const Points here = random_points(3000, {vec3(-20), vec3(20)});
    const std::vector<float> before = density_at(recipe, 2, here);
    for (const double later : {3.0, 2.5, 66.0}) {
        Points there;
        for (size_t i = 0; i < here.size(); ++i) there.add(here.at(i) + recipe.wind * static_cast<float>(later - 2));
        const std::vector<float> after = density_at(recipe, later, there);
        for (size_t i = 0; i < here.size(); ++i) ASSERT_NEAR(after[i], before[i], 2e-4) << later;
    }
}

TEST(RecipeDensity, AFieldCarriedFarIsAsSmoothAsOneAtHome) {
    // 2^27 m of wind: a float there resolves 8 m. Against the noise written out in double.
    FogRecipe recipe;
    recipe.bounds = {vec3(-2), vec3(2)};
    recipe.threshold = 0, recipe.gain = 1;
    recipe.wind = vec3(1024, 0, -512);
    const double seconds = 131072.375;
    const Points points = random_points(2000, recipe.bounds);
    const std::vector<float> density = density_at(recipe, seconds, points);
    const NoiseSum sum = noise_sum(recipe.noise, {{.displacement = dvec3(recipe.wind) * seconds}}, dvec3(0));
    for (size_t i = 0; i < points.size(); ++i)
        ASSERT_NEAR(density[i], (plain_sum(sum, dvec3(points.at(i))) + 1) / 2, 1e-5) << i;
}

TEST(RecipeSwirl, HasNoSourcesAndTheSizeAskedFor) {
    FogRecipe recipe;
    recipe.bounds = {vec3(-100), vec3(100)};
    recipe.swirl = 0.3f, recipe.swirl_scale = 2;
    const Points random = random_points(20000, {vec3(-90), vec3(90)});
    std::vector<vec3> points, moved;
    for (size_t i = 0; i < random.size(); ++i) points.push_back(random.at(i));
    moved.resize(points.size());
    recipe_swirl(recipe, 1.5, points, moved);
    double square = 0, largest = 0;
    for (const vec3 d : moved)
        square += glm::dot(d, d), largest = std::max<double>(largest, max_component(glm::abs(d)));
    EXPECT_NEAR(std::sqrt(square / moved.size()), 0.3, 0.01);
    EXPECT_LE(largest, fog_field(recipe, 1.5).swirl_reach);

    // Divergence by central differences, against the slopes it is made of.
    constexpr float h = 0.01f;
    double divergence = 0, slope = 0;
    for (size_t i = 0; i < 500; ++i) {
        std::vector<vec3> around, there(6);
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-h, h}) {
                vec3 p = points[i];
                p[axis] += side;
                around.push_back(p);
            }
        recipe_swirl(recipe, 1.5, around, there);
        const vec3 d((there[1].x - there[0].x), (there[3].y - there[2].y), (there[5].z - there[4].z));
        divergence += std::abs(d.x + d.y + d.z), slope += std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    }
    EXPECT_LT(divergence / slope, 1e-3);
}

TEST(RecipeSwirl, ChangesNoFasterThanItsBound) {
    FogRecipe recipe;
    recipe.bounds = {vec3(-10), vec3(10)};
    recipe.swirl = 0.3f, recipe.swirl_scale = 0.7f;
    const FogField field = fog_field(recipe, 0);
    std::mt19937 random(3);
    const Points ends = random_points(20000, recipe.bounds);
    std::vector<vec3> a, b, da(ends.size()), db(ends.size());
    for (size_t i = 0; i < ends.size(); ++i) {
        a.push_back(ends.at(i));
        b.push_back(ends.at(i) + vec3(random() % 100, random() % 100, random() % 100) * 1e-3f);
    }
    recipe_swirl(recipe, 0, a, da), recipe_swirl(recipe, 0, b, db);
    double used = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const vec3 way = b[i] - a[i];
        const float most = (way.x + way.y + way.z) * field.swirl_stretch + 1e-5f;
        const float change = max_component(glm::abs(db[i] - da[i]));
        ASSERT_LE(change, most);
        used = std::max<double>(used, change / most);
    }
    EXPECT_GT(used, 0.1) << "the bound would be worth nothing";
}
}
}

// Recipes for the tests, and their density at points.
#pragma once
#include "volume/noise/noise_fixtures.h"
#include "volume/recipe/field.h"

#include <filesystem>
#include <fstream>

namespace tyndall::testing {
inline std::vector<float> density_at(const FogRecipe& recipe, double seconds, const Points& points) {
    std::vector<float> values(points.size());
    recipe_density(recipe, seconds, points.x, points.y, points.z, values);
    return values;
}

// Noise that is never cut off: what is left is the shape.
inline FogRecipe full_fog() {
    FogRecipe recipe;
    recipe.bounds = {vec3(-1, 0, -2), vec3(3, 2, 2)};
    recipe.threshold = 0, recipe.gain = 1000;
    return recipe;
}

// Everything moves, turns and is shaped.
inline FogRecipe busy_fog(uint32_t seed = 1) {
    FogRecipe recipe;
    recipe.bounds = {vec3(-3, -1, -2), vec3(3.13f, 2, 2.4f)};
    recipe.voxel_size = 0.06;
    recipe.noise = {.octaves = 4, .scale = 0.9f, .seed = seed, .evolve = 0.3f};
    recipe.threshold = 0.52f, recipe.gain = 6, recipe.soft_edge = 0.05f, recipe.border = vec3(0.3f);
    recipe.height_base = 0.5f, recipe.height_falloff = 0.8f;
    recipe.wind = vec3(0.4f, 0, -0.2f);
    recipe.swirl = 0.15f, recipe.swirl_scale = 1.1f, recipe.swirl_speed = 0.2f;
    recipe.period = 4;
    return recipe;
}

// A recipe of random make, for brute force.
inline FogRecipe random_recipe(std::mt19937& random, float across) {
    const auto uniform = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    FogRecipe recipe;
    // Binary fractions: voxel centers are the same floats in the world and about the middle of the bounds.
    const auto exact = [](vec3 v) { return glm::round(v * 16.0f) / 16.0f; };
    recipe.bounds.low = exact(vec3(uniform(-50, 50), uniform(-5, 5), uniform(-50, 50)));
    recipe.bounds.high = recipe.bounds.low + exact(across * vec3(uniform(0.8f, 1), uniform(0.8f, 1), uniform(0.8f, 1)));
    recipe.voxel_size = 0.0625;
    recipe.noise = {.octaves = 1 + static_cast<int>(random() % 6),
                    .scale = std::exp(uniform(-1.2f, 1.5f)),
                    .lacunarity = uniform(1.8f, 2.3f),
                    .gain = uniform(0.35f, 0.65f),
                    .seed = static_cast<uint32_t>(random()),
                    .evolve = random() % 2 ? 0.3f : 0.0f,
                    .billow = random() % 3 == 0};
    recipe.threshold = uniform(0.5f, 0.75f), recipe.gain = uniform(1, 8);
    recipe.soft_edge = random() % 2 ? uniform(0, 0.1f) : 0;
    recipe.border = random() % 2 ? vec3(uniform(0, 1)) : vec3(0);
    if (random() % 3 == 0) recipe.height_base = recipe.bounds.low.y + 0.5f, recipe.height_falloff = uniform(0.1f, 2);
    if (random() % 3 == 0)
        recipe.shape = FogShape::ellipsoid, recipe.shape_strength = uniform(0, 0.4f),
        recipe.shape_level = uniform(0.1f, 0.9f);
    if (random() % 2) recipe.wind = vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    if (random() % 2) recipe.swirl = uniform(0, 0.4f), recipe.swirl_scale = uniform(0.5f, 3), recipe.swirl_speed = 0.2f;
    if (random() % 2) recipe.period = uniform(1, 9);
    return recipe;
}
}

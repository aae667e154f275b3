#include "base/parallel.h"
#include "support/expect.h"
#include "support/threads.h"
#include "volume/recipe/recipe_fixtures.h"

#include <gtest/gtest.h>

namespace tyndall::testing {
namespace {
ivec3 voxels_of(const FogRecipe& recipe) {
    return ivec3(glm::ceil((dvec3(recipe.bounds.high) - dvec3(recipe.bounds.low)) / recipe.voxel_size - 0.5));
}

// Every voxel of the bounds asked for by itself, z fastest.
std::vector<float> brute_force(const FogRecipe& recipe, double seconds) {
    const ivec3 size = voxels_of(recipe);
    std::vector<float> values(size_t(size.x) * size.y * size.z);
    parallel_for(size.x, [&](int64_t x) {
        Points points;
        for (int y = 0; y < size.y; ++y)
            for (int z = 0; z < size.z; ++z)
                points.add(dvec3(recipe.bounds.low) + (dvec3(x, y, z) + 0.5) * recipe.voxel_size);
        const std::vector<float> density = density_at(recipe, seconds, points);
        std::copy(density.begin(), density.end(), values.begin() + x * size.y * size.z);
    });
    return values;
}

struct Comparison {
    int64_t leaves = 0, full_leaves = 0, missing = 0, different = 0;
};

// Counts voxels with fog that generate() left out, and values that are not those of the recipe.
Comparison compare_with_brute_force(const FogRecipe& recipe, double seconds, GenerateReport* report = nullptr,
                                    float tolerance = 0) {
    const std::vector<float> expected = brute_force(recipe, seconds);
    const SparseVolume volume = generate(recipe, seconds, report);
    const ivec3 size = voxels_of(recipe);
    std::vector<float> grown(expected.size(), 0.0f);
    Comparison result;
    for (const Leaf& leaf : volume.leaves)
        for (int i = 0; i < 512; ++i) {
            const ivec3 at = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8);
            if (glm::all(glm::lessThan(at, size)))
                grown[(size_t(at.x) * size.y + at.y) * size.z + at.z] = leaf.values[i];
            else
                EXPECT_EQ(leaf.values[i], 0) << "outside the bounds";
        }
    for (size_t i = 0; i < grown.size(); ++i) {
        result.missing += grown[i] == 0 && expected[i] != 0;
        result.different += std::abs(grown[i] - expected[i]) > tolerance;
    }
    const ivec3 leaves = (size + 7) / 8;
    result.leaves = int64_t{leaves.x} * leaves.y * leaves.z, result.full_leaves = volume.leaves.size();
    return result;
}

void expect_no_hole(int recipes, float across, uint32_t seed, int64_t min_leaves) {
    std::mt19937 random(seed);
    int64_t leaves = 0, full = 0;
    for (int i = 0; i < recipes; ++i) {
        const FogRecipe recipe = random_recipe(random, across);
        GenerateReport report;
        const Comparison found = compare_with_brute_force(recipe, i * 0.37, &report);
        ASSERT_EQ(found.missing, 0) << "recipe " << i;
        ASSERT_EQ(found.different, 0) << "recipe " << i;
        ASSERT_EQ(report.leaves, found.leaves);
        ASSERT_EQ(report.kept, found.full_leaves);
        leaves += found.leaves, full += found.full_leaves;
    }
    EXPECT_GE(leaves, min_leaves);
    EXPECT_GT(full, leaves / 50) << "hardly any fog was tested";
    EXPECT_LT(full, leaves * 9 / 10) << "hardly any empty leaf was tested";
}

TEST(RecipeGrow, LeavesOutNothing) { expect_no_hole(40, 5, 1, 20000); }
TEST(RecipeGrow, NightlyLeavesOutNothingInAMillionLeaves) { expect_no_hole(310, 9.5f, 2, 1000000); }

TEST(RecipeGrow, ComputesLittleForNothing) {
    // Fog of several octaves that fills a tenth to a half of space: voxels computed to the last octave in leaves that
    // turn out empty are the false positives of the bounds.
    for (const float threshold : {0.5f, 0.55f, 0.6f})
        for (const float scale : {0.7f, 2.5f}) {
            FogRecipe recipe;
            recipe.bounds = {vec3(-4), vec3(4)};
            recipe.noise = {.octaves = 5, .scale = scale, .seed = 3};
            recipe.threshold = threshold;
            GenerateReport report;
            generate(recipe, 0, &report);
            EXPECT_GT(report.kept, report.leaves / 10);
            EXPECT_LT(report.wasted, report.finished / 10) << threshold << " at " << scale;
        }
    // Around a cloud, whole leaves are ruled out without a look at their voxels.
    FogRecipe cloud;
    cloud.bounds = {vec3(-4), vec3(4)};
    cloud.noise.scale = 2, cloud.shape = FogShape::ellipsoid;
    GenerateReport report;
    generate(cloud, 0, &report);
    EXPECT_LT(report.tried, report.leaves * 7 / 10);
    EXPECT_LT(report.wasted, report.finished / 20);
}

// Voxel centers that are no binary fractions reach recipe_density() rounded to floats: the last digits may differ.
TEST(RecipeGrow, BusyFogEqualsItsDefinition) {
    for (const double seconds : {0.0, 1.3, 2.0}) {
        const Comparison found = compare_with_brute_force(busy_fog(), seconds, nullptr, 1e-3f);
        EXPECT_EQ(found.different, 0);
        EXPECT_GT(found.full_leaves, found.leaves / 10);
    }
}

TEST(RecipeGrow, LeavesAreSortedWholeAndUseful) {
    GenerateReport report;
    const SparseVolume volume = generate(busy_fog(), 1, &report);
    ASSERT_FALSE(volume.empty());
    ivec3 low(1 << 30), high(-1), before(-1);
    int64_t voxels = 0;
    for (const Leaf& leaf : volume.leaves) {
        const ivec3 o = leaf.origin;
        EXPECT_EQ(o % 8, ivec3(0));
        EXPECT_TRUE(std::tie(before.x, before.y, before.z) < std::tie(o.x, o.y, o.z));
        before = o;
        bool any = false;
        for (int i = 0; i < 512; ++i) {
            const float value = leaf.values[i];
            ASSERT_TRUE(value == 0 || (value >= min_density && value <= 1)) << value;
            if (value == 0) continue;
            any = true, ++voxels;
            const ivec3 at = o + ivec3(i / 64, i / 8 % 8, i % 8);
            low = glm::min(low, at), high = glm::max(high, at);
        }
        EXPECT_TRUE(any) << "an empty leaf was kept";
    }
    EXPECT_EQ(volume.active_low, low);
    EXPECT_EQ(volume.active_high, high);
    EXPECT_EQ(report.voxels, voxels);
    EXPECT_TRUE(volume.tiles.empty());
}

TEST(RecipeGrow, VoxelCentersLieHalfAVoxelInside) {
    FogRecipe recipe = full_fog();
    recipe.bounds = {vec3(-1, 2, 5), vec3(1, 3, 5.5f)};
    recipe.voxel_size = 0.1;
    recipe.height_base = 2, recipe.height_falloff = 0.5f;
    const SparseVolume volume = generate(recipe, 0);
    EXPECT_EQ(volume.active_low, ivec3(0));
    EXPECT_EQ(volume.active_high, ivec3(19, 9, 4));
    const dvec3 first = dvec3(volume.index_to_world * glm::dvec4(0, 0, 0, 1));
    EXPECT_NEAR(glm::distance(first, dvec3(-0.95, 2.05, 5.05)), 0, 1e-12);
    for (const Leaf& leaf : volume.leaves)
        for (int i = 0; i < 512; ++i) {
            const ivec3 at = leaf.origin + ivec3(i / 64, i / 8 % 8, i % 8);
            const double y = (volume.index_to_world * glm::dvec4(dvec3(at), 1)).y;
            const bool inside = glm::all(glm::lessThanEqual(at, ivec3(19, 9, 4)));
            ASSERT_NEAR(leaf.values[i], inside ? std::exp(-(y - 2) / 0.5) : 0, 1e-5);
        }
}

TEST(RecipeGrow, ThreadsAndInstructionSetsGiveTheSameBits) {
    const auto bytes = [] {
        std::string all;
        for (const Leaf& leaf : generate(busy_fog(), 1.1).leaves)
            all.append(reinterpret_cast<const char*>(&leaf), sizeof leaf);
        return all;
    };
    const std::string alone = on_threads(1, bytes);
    EXPECT_EQ(on_threads(2, bytes), alone);
    EXPECT_GT(alone.size(), 100000u);
    for (const char* name : {"avx2", "avx512"}) {
        if (!has_isa(name)) continue;
        const WithIsa isa(name);
        EXPECT_EQ(bytes(), alone) << name;
    }
}

TEST(RecipeGrow, FogThatIsThinnedToNothingIsEmpty) {
    FogRecipe recipe;
    recipe.threshold = 1;
    const SparseVolume none = generate(recipe, 0);
    EXPECT_TRUE(none.empty());
    EXPECT_TRUE(none.leaves.empty());
    recipe = full_fog();
    recipe.height_base = -100, recipe.height_falloff = 1;
    EXPECT_TRUE(generate(recipe, 0).leaves.empty());
}

TEST(RecipeGrow, ImpossibleGridsAreRefusedAtOnce) {
    const auto code_of = [](const FogRecipe& recipe) {
        const Error error = error_of([&] { generate(recipe, 0); });
        EXPECT_NE(std::string(error.what()).find("voxel_size"), std::string::npos) << error.what();
        return error.code;
    };
    FogRecipe recipe;
    recipe.voxel_size = 1e-5;
    EXPECT_EQ(code_of(recipe), ExitCode::out_of_memory);
    recipe.voxel_size = 1e-300;
    EXPECT_EQ(code_of(recipe), ExitCode::out_of_memory);
    recipe.voxel_size = 100;
    EXPECT_EQ(code_of(recipe), ExitCode::refused);
}
}
}

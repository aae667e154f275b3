#include "support/expect.h"
#include "volume/recipe/recipe.h"
#include "volume/recipe/recipe_fixtures.h"
#include "volume/vdb/vdb_fixtures.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::testing {
namespace {
FogRecipe recipe_of(const std::string& json) {
    const TempFolder scratch;
    return read_recipe(scratch.put("fog.json", json));
}

// The message with which a recipe is refused.
std::string refusal(const std::string& json) {
    return error_message(ExitCode::refused, [&] { recipe_of(json); });
}

const std::string shortest = R"({"bounds": {"low": [0, 0, 0], "high": [1, 2, 3]}, "voxel_size": 0.1)";

TEST(Recipe, EveryFieldIsRead) {
    const FogRecipe recipe = recipe_of(R"({
        "$schema": "recipe.schema.json", "tyndall": 1, "description": "for the test", // with a comment
        "name": "dust", "bounds": {"low": [-1, -2, -3], "high": [4, 5, 6]}, "voxel_size": 0.125,
        "noise": {"octaves": 7, "scale": 2.5, "lacunarity": 1.75, "gain": 0.625, "seed": 4294967295, "evolve": 0.5, "billow": true},
        "density": {"threshold": 0.25, "gain": 3.5, "soft_edge": 0.125, "border": [0.5, 0, 1.5]},
        "shape": {"kind": "ellipsoid", "strength": 0.375, "level": 0.75},
        "height": {"base": 1.5, "falloff": 2.25},
        "wind": [1, 0.5, -0.25], "swirl": {"amount": 0.0625, "scale": 1.25, "speed": 0.75}, "period": 4.5,
        "fire": {"base": [1, 2, 3], "height": 1.25, "radius": 0.375, "taper": 0.5, "core": 1850, "edge": 1000, "air": 290,
                 "flicker": 0.75, "rise": 2.5, "stretch": 3.5, "noise": {"scale": 0.125, "seed": 7}, "soot": 0.0625,
                 "smoke": {"start": 0.25, "spread": 0.1875}},
        "optics": {"extinction": 0.875, "albedo": [0.5, 0.25, 1], "g": -0.5}, "frame_rate": 30})");
    EXPECT_EQ(recipe.name, "dust");
    EXPECT_EQ(recipe.bounds.low, vec3(-1, -2, -3));
    EXPECT_EQ(recipe.bounds.high, vec3(4, 5, 6));
    EXPECT_EQ(recipe.voxel_size, 0.125);
    EXPECT_EQ(recipe.noise.octaves, 7);
    EXPECT_EQ(recipe.noise.scale, 2.5f);
    EXPECT_EQ(recipe.noise.lacunarity, 1.75f);
    EXPECT_EQ(recipe.noise.gain, 0.625f);
    EXPECT_EQ(recipe.noise.seed, 4294967295u);
    EXPECT_EQ(recipe.noise.evolve, 0.5f);
    EXPECT_TRUE(recipe.noise.billow);
    EXPECT_EQ(recipe.threshold, 0.25f);
    EXPECT_EQ(recipe.gain, 3.5f);
    EXPECT_EQ(recipe.soft_edge, 0.125f);
    EXPECT_EQ(recipe.border, vec3(0.5f, 0, 1.5f));
    EXPECT_EQ(recipe.shape, FogShape::ellipsoid);
    EXPECT_EQ(recipe.shape_strength, 0.375f);
    EXPECT_EQ(recipe.shape_level, 0.75f);
    EXPECT_EQ(recipe.height_base, 1.5f);
    EXPECT_EQ(recipe.height_falloff, 2.25f);
    EXPECT_EQ(recipe.wind, vec3(1, 0.5f, -0.25f));
    EXPECT_EQ(recipe.swirl, 0.0625f);
    EXPECT_EQ(recipe.swirl_scale, 1.25f);
    EXPECT_EQ(recipe.swirl_speed, 0.75f);
    EXPECT_EQ(recipe.period, 4.5);
    EXPECT_EQ(recipe.extinction, 0.875f);
    EXPECT_EQ(recipe.albedo, vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(recipe.g, -0.5f);
    EXPECT_EQ(recipe.frame_rate, 30);
    ASSERT_TRUE(recipe.fire);
    EXPECT_EQ(recipe.fire->base, vec3(1, 2, 3));
    EXPECT_EQ(recipe.fire->height, 1.25f);
    EXPECT_EQ(recipe.fire->radius, 0.375f);
    EXPECT_EQ(recipe.fire->taper, 0.5f);
    EXPECT_EQ(recipe.fire->core, 1850);
    EXPECT_EQ(recipe.fire->edge, 1000);
    EXPECT_EQ(recipe.fire->air, 290);
    EXPECT_EQ(recipe.fire->flicker, 0.75f);
    EXPECT_EQ(recipe.fire->rise, 2.5f);
    EXPECT_EQ(recipe.fire->stretch, 3.5f);
    EXPECT_EQ(recipe.fire->noise.scale, 0.125f);
    EXPECT_EQ(recipe.fire->noise.seed, 7u);
    EXPECT_EQ(recipe.fire->soot, 0.0625f);
    EXPECT_EQ(recipe.fire->smoke_start, 0.25f);
    EXPECT_EQ(recipe.fire->smoke_spread, 0.1875f);
}

TEST(Recipe, WhatIsNotSaidStaysAtItsDefault) {
    FogRecipe expected;
    expected.bounds = {vec3(0), vec3(1, 2, 3)};
    expected.voxel_size = 0.1;
    EXPECT_EQ(recipe_hash(recipe_of(shortest + "}")), recipe_hash(expected));
    EXPECT_EQ(recipe_of(shortest + R"(, "density": {"border": 0.5}})").border, vec3(0.5f));
    EXPECT_EQ(recipe_of(shortest + R"(, "optics": {"albedo": 0.5}})").albedo, vec3(0.5f));
    expected.fire = FireRecipe{.height = 2, .radius = 0.5f};
    expected.fire->noise.scale = 0.4f;
    EXPECT_EQ(recipe_hash(recipe_of(shortest + R"(, "fire": {"height": 2, "radius": 0.5}})")), recipe_hash(expected));
    const FogRecipe cool = recipe_of(shortest + R"(, "fire": {"height": 1, "core": 250}})");
    EXPECT_EQ(cool.fire->edge, 250);
    EXPECT_EQ(cool.fire->air, 250);
}

TEST(Recipe, MistakesAreNamed) {
    const struct {
        const char* rest;
        const char* word;
    } cases[] = {{R"(, "voxel_sise": 1})", "voxel_sise"},
                 {R"(, "noise": {"octaves": 13}})", "/noise/octaves"},
                 {R"(, "noise": {"octaves": 2.5}})", "/noise/octaves"},
                 {R"(, "noise": {"scale": 0}})", "/noise/scale"},
                 {R"(, "noise": {"seed": -1}})", "/noise/seed"},
                 {R"(, "density": {"threshold": "low"}})", "/density/threshold"},
                 {R"(, "density": {"border": [1, 2]}})", "/density/border"},
                 {R"(, "density": {"border": -1}})", "/density/border"},
                 {R"(, "shape": {"kind": "ball"}})", "/shape/kind"},
                 {R"(, "shape": {}})", "kind"},
                 {R"(, "height": {"base": 1}})", "falloff"},
                 {R"(, "wind": 3})", "/wind"},
                 {R"(, "swirl": {"amount": 1, "scale": -1}})", "/swirl/scale"},
                 {R"(, "period": -4})", "/period"},
                 {R"(, "optics": {"albedo": 1.5}})", "/optics/albedo"},
                 {R"(, "optics": {"g": 1}})", "/optics/g"},
                 {R"(, "frame_rate": 0})", "/frame_rate"},
                 {R"(, "fire": {}})", "height"},
                 {R"(, "fire": {"height": 0}})", "/fire/height"},
                 {R"(, "fire": {"height": 1, "radius": -1}})", "/fire/radius"},
                 {R"(, "fire": {"height": 1, "core": -1}})", "/fire/core"},
                 {R"(, "fire": {"height": 1, "core": 1e9}})", "/fire/core"},
                 {R"(, "fire": {"height": 1, "edge": 2000}})", "/fire/edge"},
                 {R"(, "fire": {"height": 1, "air": 1200}})", "/fire/air"},
                 {R"(, "fire": {"height": 1, "noise": {"octaves": 0}}})", "/fire/noise/octaves"},
                 {R"(, "fire": {"height": 1, "smoke": {"spread": -1}}})", "/fire/smoke/spread"},
                 {R"(, "fire": {"height": 1, "stretch": 0}})", "/fire/stretch"},
                 {R"(, "fire": {"height": 1}, "name": "temperature"})", "/name"},
                 {R"(, "name": "a/b"})", "/name"}};
    for (const auto& [rest, word] : cases) {
        const std::string message = refusal(shortest + rest);
        EXPECT_NE(message.find(word), std::string::npos) << rest << " said " << message;
        EXPECT_NE(message.find("fog.json"), std::string::npos) << message;
    }
    EXPECT_NE(refusal(R"({"bounds": {"low": [0, 0, 0], "high": [1, 0, 1]}, "voxel_size": 0.1})").find("/bounds/high/1"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"bounds": {"low": [0, 0, 0], "high": [1, 1, 1]}, "voxel_size": 2})").find("/voxel_size"),
              std::string::npos);
    EXPECT_NE(refusal(R"({"bounds": {"low": [0, 0, 0], "high": [9, 1, 9]}, "voxel_size": 2})").find("/voxel_size"),
              std::string::npos); // larger than one side
    EXPECT_NE(refusal(R"({"voxel_size": 2})").find("bounds"), std::string::npos);
    EXPECT_NE(refusal("[]"), "");
}

TEST(Recipe, TheHashKnowsEveryField) {
    std::set<std::string> hashes{recipe_hash({})};
    const auto changed = [&](auto change) {
        FogRecipe recipe;
        change(recipe);
        const std::string hash = recipe_hash(recipe);
        EXPECT_EQ(hash.size(), 32u);
        EXPECT_TRUE(hashes.insert(hash).second) << hashes.size();
    };
    changed([](FogRecipe& r) { r.name = "x"; });
    for (int axis = 0; axis < 3; ++axis) {
        changed([&](FogRecipe& r) { r.bounds.low[axis] -= 1; });
        changed([&](FogRecipe& r) { r.bounds.high[axis] += 1; });
        changed([&](FogRecipe& r) { r.border[axis] += 1; });
        changed([&](FogRecipe& r) { r.wind[axis] += 1; });
        changed([&](FogRecipe& r) { r.albedo[axis] = 0.5f; });
    }
    changed([](FogRecipe& r) { r.voxel_size = 0.1; });
    changed([](FogRecipe& r) { r.noise.octaves = 4; });
    changed([](FogRecipe& r) { r.noise.scale = 3; });
    changed([](FogRecipe& r) { r.noise.lacunarity = 3; });
    changed([](FogRecipe& r) { r.noise.gain = 0.25f; });
    changed([](FogRecipe& r) { r.noise.seed = 4294967295u; });
    changed([](FogRecipe& r) { r.noise.evolve = 0.5f; });
    changed([](FogRecipe& r) { r.noise.billow = true; });
    changed([](FogRecipe& r) { r.threshold = 0.25f; });
    changed([](FogRecipe& r) { r.gain = 5; });
    changed([](FogRecipe& r) { r.soft_edge = 0.0625f; });
    changed([](FogRecipe& r) { r.shape = FogShape::ellipsoid; });
    changed([](FogRecipe& r) { r.shape_strength = 0.125f; });
    changed([](FogRecipe& r) { r.shape_level = 0.125f; });
    changed([](FogRecipe& r) { r.height_base = 0.75f; });
    changed([](FogRecipe& r) { r.height_falloff = 0.875f; });
    changed([](FogRecipe& r) { r.swirl = 0.5f; });
    changed([](FogRecipe& r) { r.swirl_scale = 0.5f; });
    changed([](FogRecipe& r) { r.swirl_speed = 0.5f; });
    changed([](FogRecipe& r) { r.period = 5; });
    changed([](FogRecipe& r) { r.extinction = 5; });
    changed([](FogRecipe& r) { r.g = 0.75f; });
    changed([](FogRecipe& r) { r.frame_rate = 25; });
    const auto burning = [&](auto change) { changed([&](FogRecipe& r) { change(r.fire.emplace()); }); };
    burning([](FireRecipe&) {});
    for (int axis = 0; axis < 3; ++axis) burning([&](FireRecipe& f) { f.base[axis] = 0.5f; });
    burning([](FireRecipe& f) { f.height = 0.5f; });
    burning([](FireRecipe& f) { f.radius = 0.5f; });
    burning([](FireRecipe& f) { f.taper = 0.5f; });
    burning([](FireRecipe& f) { f.core = 1800; });
    burning([](FireRecipe& f) { f.edge = 1000; });
    burning([](FireRecipe& f) { f.air = 280; });
    burning([](FireRecipe& f) { f.flicker = 0.25f; });
    burning([](FireRecipe& f) { f.rise = 0.25f; });
    burning([](FireRecipe& f) { f.stretch = 0.25f; });
    burning([](FireRecipe& f) { f.soot = 0.25f; });
    burning([](FireRecipe& f) { f.smoke_start = 0.25f; });
    burning([](FireRecipe& f) { f.smoke_spread = 0.25f; });
    burning([](FireRecipe& f) { f.noise.seed = 5; });
    burning([](FireRecipe& f) { f.noise.scale = 5; });
}

TEST(Recipe, ThoseThatComeWithTheProgramMakeFog) {
    int recipes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(TYNDALL_SOURCE_DIR "/volumes")) {
        const std::string name = entry.path().filename();
        if (entry.path().extension() != ".json" || name == "recipe.schema.json") continue;
        SCOPED_TRACE(name);
        ++recipes;
        const FogRecipe recipe = read_recipe(entry.path());
        GenerateReport report;
        const SparseVolume volume = generate(recipe, 0.5, &report);
        EXPECT_GT(volume.leaves.size(), 100u);
        EXPECT_LT(report.leaves, 8000) << "takes long";
        EXPECT_LE(report.wasted, report.finished / 10);
        double sum = 0;
        int64_t fog = 0;
        for (const Leaf& leaf : volume.leaves)
            for (const float value : leaf.values) sum += value, fog += value > 0;
        EXPECT_GT(sum / fog, 0.05) << "too thin to see";

        // Nothing is cut off at a face of the bounds, but where a room or the ground ends it.
        if (recipe.border != vec3(0) || recipe.shape == FogShape::ellipsoid) {
            Points sides = random_points(500, recipe.bounds);
            for (size_t i = 0; i < sides.size(); ++i)
                (i % 2 ? sides.x : sides.z)[i] = (i % 2 ? recipe.bounds.low.x : recipe.bounds.high.z);
            for (const float value : density_at(recipe, 0.5, sides)) EXPECT_EQ(value, 0);
        }
    }
    EXPECT_GE(recipes, 5);
}
}
}

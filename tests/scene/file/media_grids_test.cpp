// What a medium takes from grids beside its density: read as it is written, or refused by field.
#include "scene/file/medium_words.h"
#include "scene/input_files.h"
#include "support/expect.h"
#include "support/load_answer.h"
#include "support/scratch.h"
#include "volume/vdb/vdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

// A grid of one voxel of a value.
SparseVolume voxel(const std::string& name, float value) {
    SparseVolume volume;
    volume.name = name, volume.active_high = ivec3(0);
    volume.leaves.emplace_back(Leaf{}).values[0] = value;
    return volume;
}

LoadResult load_medium(const TempFolder& folder, const std::string& members) {
    write_vdb(folder / "fire.vdb", voxel("density", 1));
    write_vdb(folder / "other.0002.vdb", voxel("t", 1));
    return load(folder.put("scene.json", R"({"tyndall": 1, "media": [{"type": "vdb", "file": "fire.vdb", )"
                                         R"("extinction": 1, )" +
                                             members + "}]}"));
}

TEST(MediaGrids, ARecipeHasItsTemperatureFromItsFire) {
    const TempFolder folder;
    const std::string bounds = R"({"bounds": {"low": [-1, 0, -1], "high": [1, 2, 1]}, "voxel_size": 0.1)";
    folder.put("fog.json", bounds + "}");
    folder.put("fire.json", bounds + R"(, "fire": {"height": 1}})");
    const auto load_recipe = [&](const std::string& members) {
        return load(folder.put("scene.json", R"({"tyndall": 1, "media": [{"type": "noise", )" + members + "}]}"));
    };
    const std::string blackbody = R"(, "blackbody": {"convention": "kelvin", "emission_scale": 2})";
    const LoadResult fire = load_recipe(R"("recipe": "fire.json")" + blackbody);
    ASSERT_TRUE(fire.loaded) << fire.message;
    EXPECT_THAT(fire.scene.warnings, Not(Contains(HasSubstr("gives no light"))));
    EXPECT_EQ(fire.scene.media[0].blackbody->scale.at(0), 2);
    EXPECT_TRUE(emits_light(fire.scene.media[0]));
    const LoadResult fog = load_recipe(R"("recipe": "fog.json")" + blackbody);
    EXPECT_FALSE(fog.loaded);
    EXPECT_THAT(fog.message, HasSubstr("/media/0/blackbody"));
    EXPECT_THAT(fog.message, HasSubstr("\"fire\""));
    const LoadResult dark = load_recipe(R"("recipe": "fire.json")");
    EXPECT_THAT(dark.scene.warnings, Contains(HasSubstr("gives no light")));
}

TEST(MediaGrids, AreReadAsTheyAreWritten) {
    const TempFolder folder;
    const LoadResult answer = load_medium(folder, R"(
        "emission": [1, 2, 3], "sequence": {"offset": 1},
        "grids": {
          "density": {"scale": 2, "clamp": [0, 0.5]},
          "albedo": "Cd",
          "emission": {"grid": ["e.r", "e.g", "e.b"]},
          "temperature": {"file": "other.####.vdb", "grid": "t", "scale": 1500, "offset": 300, "remap": [[0, 0], [2000, 1900]]},
          "flame": {}},
        "blackbody": {"convention": "kelvin", "emission_scale": {"keys": [[0, 1], [1, 2]]}, "kirchhoff": true, "tint": 0.5})");
    ASSERT_TRUE(answer.loaded) << answer.message;
    const MediumSource& fire = answer.scene.media[0];
    EXPECT_EQ(fire.density_map(1), 0.5f);
    EXPECT_EQ(fire.density_grid, "");
    EXPECT_THAT(fire.albedo_grid->grids, ElementsAre("Cd"));
    EXPECT_THAT(fire.emission_grid->grids, ElementsAre("e.r", "e.g", "e.b"));
    EXPECT_EQ(fire.emission.at(0), vec3(1, 2, 3));
    EXPECT_THAT(fire.temperature->grids, ElementsAre("t"));
    EXPECT_THAT(fire.temperature->sequence.files, ElementsAre(2));
    EXPECT_EQ(fire.temperature->sequence.offset, 1);
    EXPECT_EQ(fire.temperature->map(1), 1710);
    EXPECT_THAT(fire.flame->grids, ElementsAre("flame"));
    EXPECT_EQ(fire.flame->sequence.pattern, fire.sequence.pattern);
    EXPECT_TRUE(fire.blackbody->by_absorption);
    EXPECT_EQ(fire.blackbody->scale.at(0.5), 1.5f);
    EXPECT_EQ(fire.blackbody->tint.at(0), vec3(0.5f));
    EXPECT_EQ(volume_sequences(fire).size(), 2u);
    EXPECT_TRUE(emits_light(fire));
}

TEST(MediaGrids, AnEmissionIsOneUnlessItIsSaid) {
    const TempFolder folder;
    EXPECT_EQ(load_medium(folder, R"("grids": {"emission": "e"})").scene.media[0].emission.at(0), vec3(1));
    EXPECT_EQ(load_medium(folder, R"("grids": {"albedo": "Cd"})").scene.media[0].emission.at(0), vec3(0));
    const LoadResult pbrt =
        load_medium(folder, R"("grids": {"temperature": "t"}, "blackbody": {"convention": "pbrt"})");
    EXPECT_TRUE(pbrt.scene.media[0].blackbody->by_absorption);
}

TEST(MediaGrids, MistakesAreNamed) {
    const TempFolder folder;
    const auto refused = [&](const std::string& members, const char* place, const char* reason) {
        const LoadResult answer = load_medium(folder, members);
        expect_refusal(answer, std::string("scene.json: /media/0") + place);
        EXPECT_THAT(answer.message, HasSubstr(reason));
    };
    const std::string warm = R"("grids": {"temperature": "t"}, )";
    refused(R"("grids": {"temperature": "t"})", "/grids/temperature", "has no effect without \"blackbody\"");
    refused(R"("grids": {"flame": "t"})", "/grids/flame", "blackbody");
    refused(R"("blackbody": {"convention": "kelvin"})", "/blackbody", "needs a temperature");
    refused(warm + R"("blackbody": {})", "/blackbody", "convention");
    refused(warm + R"("blackbody": {"convention": "arnold"})", "/blackbody/convention", "kelvin");
    refused(warm + R"("blackbody": {"convention": "pbrt", "kirchhoff": true})", "/blackbody/kirchhoff", "kelvin");
    refused(warm + R"("blackbody": {"convention": "kelvin", "intensity": 1})", "/blackbody/intensity", "cycles");
    refused(warm + R"("blackbody": {"convention": "pbrt", "Lescale": 1})", "/blackbody/Lescale", "emission_scale");
    refused(R"("grids": {"albedo": {"clamp": [1, 1]}})", "/grids/albedo/clamp/1", "greater");
    refused(R"("grids": {"albedo": {"remap": [[0, 0], [0, 1]]}})", "/grids/albedo/remap/1/0", "greater");
    refused(R"("grids": {"albedo": {"width": 1}})", "/grids/albedo", "width");
    refused(R"("grids": {"density": {"width": 0}})", "/grids/density", "");
    refused(R"("grid": "density", "grids": {"density": "density"})", "/grid", "grids");
    refused(R"("grids": {"temprature": "t"})", "/grids/temprature", "temperature");
    const LoadResult gone = load_medium(folder, R"("grids": {"albedo": {"file": "none.vdb"}})");
    expect_refusal(gone, "/media/0/grids/albedo/file", ExitCode::unreadable);
}

TEST(MediaGrids, WhatEmitsAsItAbsorbsNeedsAnExtinction) {
    const TempFolder folder;
    write_vdb(folder / "fire.vdb", voxel("density", 1));
    const LoadResult answer =
        load(folder.put("scene.json", R"({"tyndall": 1, "media": [{"type": "vdb", "file": "fire.vdb",
        "extinction": 0, "grids": {"temperature": "t"}, "blackbody": {"convention": "pbrt"}}]})"));
    EXPECT_TRUE(has_warning(answer.scene, "/media/0/blackbody: emission is proportional to absorption"));
}

VdbGridInfo grid(const std::string& name, GridRole role, float maximum) {
    VdbGridInfo info;
    info.name = info.key = name, info.role = role, info.maximum = maximum;
    info.is_fog = role == GridRole::density;
    info.active_high = ivec3(9), info.active_voxels = 1000;
    return info;
}

TEST(MediaGrids, InfoSaysWhatToWrite) {
    VdbInfo info;
    info.grids = {grid("density", GridRole::density, 2), grid("Cd", GridRole::color, 1),
                  grid("temperature", GridRole::temperature, 4), grid("flame", GridRole::flame, 1)};
    EXPECT_EQ(
        medium_text("a/fire.vdb", info),
        R"({"type": "vdb", "file": "fire.vdb", "extinction": 0.115, "grids": {"density": "density", "albedo": "Cd", )"
        R"("temperature": {"grid": "temperature", "scale": 500}, "flame": "flame"}, )"
        R"("blackbody": {"convention": "kelvin", "emission_scale": 1}})");
    info.grids = {grid("temperature", GridRole::temperature, 2300), grid("flame", GridRole::flame, 0)};
    EXPECT_EQ(medium_text("fire.vdb", info), R"({"type": "vdb", "file": "fire.vdb", "extinction": 0, "grids": {)"
                                             R"("temperature": "temperature"}, "blackbody": {"convention": "kelvin", )"
                                             R"("emission_scale": 1}})");
    // Smoke of a simulation whose fire does not burn is warm, but does not glow.
    info.grids = {grid("density", GridRole::density, 2), grid("temperature", GridRole::temperature, 1),
                  grid("flame", GridRole::flame, 0)};
    EXPECT_EQ(medium_text("smoke.vdb", info),
              R"({"type": "vdb", "file": "smoke.vdb", "extinction": 0.115, "grids": {"density": "density"}})");
    info.grids.pop_back();
    EXPECT_THAT(medium_text("fire.vdb", info), HasSubstr(R"("temperature": {"grid": "temperature", "scale": 2000})"));
    info.grids = {grid("surface", GridRole::level_set, 3)};
    info.grids[0].background = 3;
    EXPECT_THAT(medium_text("ball.vdb", info), HasSubstr(R"("density": {"grid": "surface", "width": 1.5})"));
    EXPECT_EQ(velocity_text("ball.vdb", info), "");
    info.grids[0].background = 0, info.grids[0].minimum = -2;
    EXPECT_THAT(medium_text("inflow.vdb", info), HasSubstr(R"("density": {"grid": "surface", "width": 1})"));
    info.grids = {grid("vel", GridRole::velocity, 3)};
    EXPECT_EQ(medium_text("wind.vdb", info), "");
    EXPECT_EQ(velocity_text("a/wind.vdb", info), R"({"velocity": {"file": "wind.vdb", "grid": "vel"}})");
    // Densities end at 65504; names that a scene file cannot hold are left out.
    info.grids = {grid("density", GridRole::density, 3e38f), grid("heat\xff", GridRole::temperature, 1000)};
    EXPECT_THAT(medium_text("hot.vdb", info), EndsWith(R"("extinction": 3.53e-06, "grids": {"density": "density"}})"));
    info.grids = {grid("\xffmist", GridRole::density, 2)};
    EXPECT_EQ(medium_text("mist.vdb", info), R"({"type": "vdb", "file": "mist.vdb", "extinction": 0.115})");
}
}
}

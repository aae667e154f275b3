// Colors, mapped values and level sets: what a scene takes from grids beside plain densities.
#include "volume/vdb/vdb.h"
#include "volume/vdb/vdb_fixtures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace testing;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

AuthoredGrid grid_of(const std::string& name, const std::string& type,
                     std::vector<std::pair<ivec3, float>> voxels = {}) {
    AuthoredGrid grid;
    grid.name = name, grid.type = type, grid.voxels = std::move(voxels);
    return grid;
}

ColorVolume color_of(const std::string& bytes, const std::vector<std::string>& names, VdbReadReport* report = nullptr,
                     float most = infinity) {
    const TempFolder scratch;
    return read_color_vdb(scratch.put("in.vdb", bytes), names, ValueMap(), most, report);
}

std::string refused(const std::string& bytes, const std::vector<std::string>& names) {
    return error_message(ExitCode::refused, [&] { color_of(bytes, names); });
}

class ReadVectors : public ::testing::TestWithParam<std::tuple<const char*, bool, uint32_t>> {};

TEST_P(ReadVectors, EveryComponent) {
    const auto [type, half, packing] = GetParam();
    AuthoredGrid grid = grid_of("Cd", type);
    grid.half = half;
    for (int i = 0; i < 300; ++i) grid.colors.emplace_back(ivec3(i % 7, i % 11, i), vec3(i, 2 * i, 3 * i) / 1024.0f);
    VdbReadReport report;
    const ColorVolume color = color_of(authored({grid}, packing), {"Cd"}, &report);
    EXPECT_EQ(report.summary(), "");
    ASSERT_EQ(color.channels.size(), 3u);
    for (const auto& [at, value] : grid.colors) {
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(value_at(color.channels[static_cast<size_t>(c)], at), value[c], value[c] / 2000);
        ASSERT_EQ(value_at(color.coverage, at), 1);
    }
    EXPECT_EQ(value_at(color.coverage, {6, 0, 1}), 0);
}
INSTANTIATE_TEST_SUITE_P(All, ReadVectors,
                         ::testing::Combine(::testing::Values("vec3s", "vec3d"), ::testing::Bool(),
                                            ::testing::Values(pack_none, pack_mask, pack_zip | pack_mask,
                                                              pack_blosc | pack_mask)));

// A background of white, as Houdini writes it, is a color of no voxel; values a share cannot have are mended.
TEST(VdbColor, BackgroundIsNoColorAndValuesAreMended) {
    AuthoredGrid grid = grid_of("Cd", "vec3s");
    grid.background = 1;
    grid.colors = {{{1, 2, 3}, {-0.5f, 0.25f, 2}}, {{1, 2, 4}, {0.5f, 0.5f, 0.5f}}};
    VdbReadReport report;
    const ColorVolume color = color_of(authored({grid}), {"Cd"}, &report, 1);
    EXPECT_EQ(value_at(color.channels[0], {1, 2, 3}), 0);
    EXPECT_EQ(value_at(color.channels[1], {1, 2, 3}), 0.25f);
    EXPECT_EQ(value_at(color.channels[2], {1, 2, 3}), 1);
    EXPECT_EQ(value_at(color.channels[0], {1, 2, 5}), 0);
    EXPECT_EQ(value_at(color.coverage, {1, 2, 5}), 0);
    EXPECT_THAT(report.summary(), HasSubstr("1 negative voxels set to 0"));
    EXPECT_THAT(report.summary(), HasSubstr("1 voxels above 1 clamped to it"));
}

TEST(VdbColor, ThreeGridsOfNumbersAreOneColor) {
    const std::string bytes =
        authored({grid_of("color.x", "float", {{{0, 0, 0}, 0.25f}}), grid_of("color.y", "double", {{{0, 0, 0}, 0.5f}}),
                  grid_of("color.z", "float", {{{0, 0, 0}, 0.75f}})});
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"color"}, {"color.x", "color.y", "color.z"}}) {
        const ColorVolume color = color_of(bytes, names);
        ASSERT_EQ(color.channels.size(), 3u);
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(value_at(color.channels[static_cast<size_t>(c)], {0, 0, 0}), 0.25f * (c + 1));
    }
    EXPECT_EQ(color_of(bytes, {"color.y"}).channels.size(), 1u);
    EXPECT_THAT(refused(bytes, {"Cd"}), HasSubstr("has no grid \"Cd\"; it has color.x (float)"));
    EXPECT_THAT(refused(authored({grid_of("flags", "int32", {{{0, 0, 0}, 1}})}), {"flags"}),
                HasSubstr("holds int32 values, not a color per voxel"));
}

// A red flame leaves the other two grids inactive: its color is red, not white.
TEST(VdbColor, AVoxelThatIsActiveInAnyGridHasAColor) {
    AuthoredGrid x = grid_of("Cd.x", "float", {{{0, 0, 9}, 0.5f}}), y = grid_of("Cd.y", "float", {{{0, 0, 8}, 0.25f}}),
                 z = grid_of("Cd.z", "float");
    z.tiles = {{{0, 0, 0}, 1, 0.75f}, {{0, 0, 128}, 2, 0.75f}};
    y.voxels.push_back({{0, 0, 1}, 0.25f}), x.tiles = {{{0, 0, 136}, 1, 0.5f}};
    VdbReadReport report;
    const ColorVolume color = color_of(authored({x, y, z}), {"Cd"}, &report);
    const auto at = [&](int c, int k) { return value_at(color.channels[static_cast<size_t>(c)], {0, 0, k}); };
    for (const int covered : {1, 5, 8, 9, 130, 140, 255})
        EXPECT_EQ(value_at(color.coverage, {0, 0, covered}), 1) << covered;
    for (const int bare : {10, 127, 256}) EXPECT_EQ(value_at(color.coverage, {0, 0, bare}), 0) << bare;
    EXPECT_THAT((std::vector{at(0, 8), at(1, 8), at(2, 8)}), ElementsAre(0, 0.25f, 0));
    EXPECT_THAT((std::vector{at(0, 1), at(1, 1), at(2, 1)}), ElementsAre(0, 0.25f, 0.75f));
    EXPECT_THAT((std::vector{at(0, 140), at(1, 140), at(2, 140)}), ElementsAre(0.5f, 0, 0.75f));

    z.tiles.clear();
    color_of(authored({x, y, z}), {"Cd"}, &report);
    EXPECT_EQ(report.summary(), "") << "only one of the grids is empty";
    color_of(authored({z, z, z}), {"Cd.z", "Cd.z", "Cd.z"}, &report);
    EXPECT_THAT(report.summary(), HasSubstr("is empty"));
    y.index_to_world[3][0] = 1;
    EXPECT_THAT(refused(authored({x, y, z}), {"Cd"}), EndsWith("the three grids of a color have different transforms"));
}

TEST(VdbColor, RefusalsNameTheQuantityAndOfferWhatCanBeUsed) {
    const TempFolder scratch;
    const auto file = scratch.put("in.vdb", authored({grid_of("heat", "float"), grid_of("vel", "vec3i")}));
    EXPECT_THAT(error_message(ExitCode::refused,
                              [&] { read_velocity_vdb(file, std::vector<std::string>{"vel"}, ValueMap(), nullptr); }),
                HasSubstr("holds vec3i values, not a velocity per voxel"));
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_vdb(file, "vel", ValueMap(), 1, nullptr, "temperature"); }),
                HasSubstr("holds vec3i values, not a temperature per voxel"));
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_vdb(file); }), EndsWith("to one of heat (float)"));
}

TEST(VdbMap, ValuesAreMappedBeforeTheyAreCleaned) {
    const TempFolder scratch;
    AuthoredGrid grid = grid_of("temperature", "float",
                                {{{0, 0, 0}, -1.0f}, {{0, 0, 1}, 2.0f}, {{0, 0, 2}, std::nanf("")}, {{0, 0, 3}, 1e9f}});
    ValueMap map;
    map.scale = 100, map.offset = 300;
    VdbReadReport report;
    const SparseVolume volume = read_vdb(scratch.put("in.vdb", authored({grid})), "temperature", map, 65504, &report);
    EXPECT_EQ(value_at(volume, {0, 0, 0}), 200);
    EXPECT_EQ(value_at(volume, {0, 0, 1}), 500);
    EXPECT_EQ(value_at(volume, {0, 0, 2}), 0);
    EXPECT_EQ(value_at(volume, {0, 0, 3}), 65504);
    EXPECT_EQ(value_at(volume, {0, 0, 5}), 0) << "no voxel of the grid";
    EXPECT_THAT(report.summary(), HasSubstr("1 non-finite voxels set to 0, 1 voxels above 65504 clamped to it"));
}

// A ball of radius 6 with a narrow band of 3 voxels, and its inside as inactive voxels.
AuthoredGrid level_set() {
    AuthoredGrid grid = grid_of("surface", "float");
    grid.grid_class = "level set", grid.background = 3;
    for (int x = -12; x <= 12; ++x)
        for (int y = -12; y <= 12; ++y)
            for (int z = -12; z <= 12; ++z) {
                const float distance = glm::length(vec3(x, y, z)) - 6;
                if (std::abs(distance) < 3) grid.voxels.emplace_back(ivec3(x, y, z), distance);
                if (distance <= -3) grid.inactive_voxels.emplace_back(ivec3(x, y, z), -3.0f);
            }
    return grid;
}

TEST(VdbLevelSet, BecomesFogOfAWidthWithinItsNarrowBand) {
    const TempFolder scratch;
    const auto file = scratch.put("in.vdb", authored({level_set()}));
    ValueMap map;
    map.width = 2;
    VdbReadReport report;
    const SparseVolume fog = read_vdb(file, "", map, infinity, &report);
    EXPECT_EQ(report.summary(), "");
    EXPECT_EQ(value_at(fog, {0, 0, 0}), 1);
    EXPECT_EQ(value_at(fog, {4, 0, 0}), 1);
    EXPECT_EQ(value_at(fog, {5, 0, 0}), 0.5f);
    EXPECT_EQ(value_at(fog, {6, 0, 0}), 0);
    EXPECT_EQ(value_at(fog, {8, 0, 0}), 0);
    EXPECT_EQ(value_at(fog, {8, 8, 8}), 0);

    map.width = 3.5f;
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_vdb(file, "surface", map, infinity, nullptr); }),
                HasSubstr("its narrow band has a half width of 3, in the file's units; a \"width\" of 3.5 exceeds it"));
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_vdb(file, "surface"); }), HasSubstr("\"width\""));
    EXPECT_THAT(error_message(ExitCode::refused,
                              [&] { read_vdb(file, "surface", ValueMap(), infinity, nullptr, "temperature"); }),
                EndsWith("is a level set, which holds distances, not a temperature per voxel"));
    AuthoredGrid fog_volume = grid_of("density", "float", {{{0, 0, 0}, 1.0f}});
    fog_volume.grid_class = "fog volume";
    const auto other = scratch.put("fog.vdb", authored({fog_volume}));
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_vdb(other, "density", map, infinity, nullptr); }),
                HasSubstr("a \"width\" is for level sets"));
}

// Mantaflow writes every distance, and 0 as the background.
TEST(VdbLevelSet, WithoutANarrowBandTheWidthEndsAtItsLeastDistance) {
    const TempFolder scratch;
    AuthoredGrid grid = level_set();
    grid.background = 0;
    for (auto& [at, distance] : grid.inactive_voxels) grid.voxels.emplace_back(at, glm::length(vec3(at)) - 6);
    grid.inactive_voxels.clear();
    const auto file = scratch.put("in.vdb", authored({grid}));
    ValueMap map;
    map.width = 6;
    EXPECT_EQ(value_at(read_vdb(file, "", map, infinity, nullptr), {3, 0, 0}), 0.5f);
    map.width = 50;
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_vdb(file, "", map, infinity, nullptr); }),
                HasSubstr("its distances reach down to 6 below 0, in the file's units; a \"width\" of 50 exceeds it"));
}

TEST(VdbRoles, GridsLookLikeWhatTheyAreCalled) {
    const TempFolder scratch;
    AuthoredGrid surface = level_set();
    const auto file = scratch.put(
        "in.vdb", authored({grid_of("density", "float"), grid_of("Temperature", "float"), grid_of("flame", "float"),
                            grid_of("Cd", "vec3s"), grid_of("vel", "vec3s"), grid_of("vel.x", "float"), surface,
                            grid_of("flags", "int32"), grid_of("normal", "vec3s"), grid_of("voxel_fog", "float")}));
    std::vector<GridRole> roles;
    for (const VdbGridInfo& grid : vdb_info(file).grids) roles.push_back(grid.role);
    EXPECT_THAT(roles, ElementsAre(GridRole::density, GridRole::temperature, GridRole::flame, GridRole::color,
                                   GridRole::velocity, GridRole::velocity, GridRole::level_set, GridRole::other,
                                   GridRole::other, GridRole::density));
}
}
}

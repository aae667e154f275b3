// Fog between the frames of its files: moved as its velocities say, to the voxel, and mixed.
#include "volume/motion/moved_fog.h"

#include "support/corpus.h"
#include "support/expect.h"
#include "support/scratch.h"
#include "volume/fog_fixtures.h"
#include "volume/motion/velocity_field.h"
#include "volume/vdb/vdb_fixtures.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;
using ::testing::HasSubstr;

PlacedBricks placed(SparseVolume volume, const dmat4& index_to_world = dmat4(1)) {
    volume.index_to_world = index_to_world;
    return {make_bricks(volume), index_to_world};
}

// A smooth ball of radius 6 around a place.
SparseVolume ball(vec3 center) {
    return volume_of(ivec3(center) - 7, ivec3(center) + 8,
                     [&](int x, int y, int z) { return std::max(1 - glm::distance(vec3(x, y, z), center) / 6, 0.0f); });
}

SparseVolume filled(ivec3 low, ivec3 high, const VoxelFunction& value, const dmat4& index_to_world = dmat4(1)) {
    SparseVolume volume = volume_of(low, high, value);
    volume.index_to_world = index_to_world;
    return volume;
}

// Known in a box of voxels.
VelocityField field_in(ivec3 low, ivec3 high, const std::function<vec3(vec3)>& velocity,
                       const dmat4& index_to_world = dmat4(1)) {
    VelocityVolume volume;
    volume.known = {filled(
        low, high, [](int, int, int) { return 1.0f; }, index_to_world)};
    for (int c = 0; c < 3; ++c)
        volume.components[static_cast<size_t>(c)] = filled(
            low, high, [&](int x, int y, int z) { return velocity(vec3(x, y, z))[c]; }, index_to_world);
    return make_velocity_field(std::move(volume));
}

double mass_of(const SparseVolume& volume) {
    double mass = 0;
    for (const Leaf& leaf : volume.leaves)
        for (const float value : leaf.values) mass += double{value};
    return mass;
}

float at(const SparseVolume& volume, vec3 point) { return sample_density(*make_bricks(volume), point); }

TEST(MovedFog, IsShiftedByAConstantVelocityAndNothingIsCut) {
    const PlacedBricks fog = placed(ball({20, 4, -30}));
    // Known where the fog is and no further, as bakes of this program have it.
    const VelocityField field = field_in({13, -3, -37}, {28, 12, -22}, [](vec3) { return vec3(10, -4, 1); });
    EXPECT_NEAR(field.fastest, std::sqrt(117.0f), 1e-4);
    for (const double time : {0.5, -0.5, 2.0, 4.5}) {
        const SparseVolume moved = moved_fog(fog, field, time, "fog");
        const SparseVolume expected = ball(vec3(20, 4, -30) + static_cast<float>(time) * vec3(10, -4, 1));
        // Limiting cubic interpolation at the kinks of this ball adds some mass.
        EXPECT_NEAR(mass_of(moved), mass_of(expected), 0.005 * mass_of(expected)) << time;
        for (const vec3 offset : {vec3(0), vec3(4, 0, 0), vec3(0, -5, 0), vec3(-2, 3, 1)}) {
            const vec3 point = vec3(20, 4, -30) + static_cast<float>(time) * vec3(10, -4, 1) + offset;
            EXPECT_NEAR(at(moved, point), at(expected, point), 0.03) << time << " " << offset.x;
        }
    }
}

// Linear interpolation of voxels halfway between those of the file would lower the peak of this flame by 9 %, cubic by
// 1 %.
TEST(MovedFog, APeakBetweenVoxelsKeepsItsHeight) {
    const auto flame = [](vec3 p) { return 300 + 1500 * std::exp(-glm::dot(p, p) / 8); };
    const PlacedBricks fog =
        placed(volume_of(ivec3(-12), ivec3(12), [&](int x, int y, int z) { return flame(vec3(x, y, z)); }));
    const VelocityField field = field_in(ivec3(-12), ivec3(12), [](vec3) { return vec3(1); });
    for (const double time : {0.25, 0.5, -0.5}) {
        const SparseVolume moved = moved_fog(fog, field, time, "fire");
        const auto bricks = make_bricks(moved);
        for (const ivec3 voxel : {ivec3(0), ivec3(1, 0, 0), ivec3(2, 1, 0), ivec3(3, 3, 3)})
            EXPECT_NEAR(sample_density(*bricks, vec3(voxel)), flame(vec3(voxel) - static_cast<float>(time)), 20)
                << time;
    }
}

// Interpolation must not swing beyond the voxels' range: no cold rim around a flame, no negative density.
TEST(MovedFog, AnEdgeBetweenVoxelsDoesNotOvershoot) {
    const PlacedBricks fog =
        placed(volume_of(ivec3(0), ivec3(15), [](int x, int, int) { return x < 8 ? 1000.0f : 100.0f; }));
    const VelocityField field = field_in(ivec3(0), ivec3(15), [](vec3) { return vec3(1, 0, 0); });
    const SparseVolume moved = moved_fog(fog, field, 0.3, "fire");
    for (int x = 2; x < 15; ++x) {
        const float value = testing::value_at(moved, {x, 7, 7});
        EXPECT_TRUE(value >= 100 && value <= 1000) << x << " " << value;
    }
}

TEST(MovedFog, AnEmptyGridMovesNowhere) {
    const VelocityField field = field_in({0, 0, 0}, {7, 7, 7}, [](vec3) { return vec3(8, 0, 0); });
    EXPECT_TRUE(moved_fog(placed({}), field, 1, "fog").empty());
    const SparseVolume zero = volume_of(ivec3(0), ivec3(7), [](int, int, int) { return 0.0f; });
    EXPECT_TRUE(moved_fog(placed(zero), field, 1, "fog").empty());
}

TEST(MovedFog, WholeVoxelsKeepTheirBits) {
    const SparseVolume noise = volume_of(ivec3(-9, 3, 0), ivec3(20, 11, 17), exact_noise);
    const VelocityField field = field_in({-9, 3, 0}, {20, 11, 17}, [](vec3) { return vec3(8, 0, -16); });
    const SparseVolume moved = moved_fog(placed(noise), field, 2, "fog");
    for (int x = -9; x <= 20; x += 3)
        for (int y = 3; y <= 11; y += 2)
            for (int z = 0; z <= 17; ++z)
                ASSERT_EQ(testing::value_at(moved, {x + 16, y, z - 32}), exact_noise(x, y, z)) << x << y << z;
    EXPECT_EQ(testing::value_at(moved, {-9, 3, 0}), 0);
}

// Components with voxels of their own are looked up one by one, others at once.
TEST(MovedFog, OneLookUpGivesTheVelocityOfThree) {
    const auto swirl = [](vec3 p) { return vec3(std::sin(p.y), 2 * std::cos(p.z), 0.3f * p.x); };
    const VelocityField together = field_in({-5, -9, 2}, {20, 14, 19}, swirl);
    VelocityField apart = together;
    apart.joint = nullptr;
    ASSERT_TRUE(together.joint);
    const LocalVelocity one(together, dmat4(1)), three(apart, dmat4(1));
    for (int i = 0; i < 1000; ++i) { // beyond the known voxels as well
        const vec3 point = vec3(-7, -11, 0) + vec3(i % 10, i / 10 % 10, i / 100) * vec3(3.13f, 2.91f, 2.37f);
        vec3 a(0), b(0);
        ASSERT_EQ(one.at(point, a), three.at(point, b)) << i;
        ASSERT_LT(glm::distance(a, b), 1e-4f) << i;
    }
}

// Lengths of the file, whatever its voxels: turned and not cubic here.
TEST(MovedFog, VelocitiesAreInTheFilesSpace) {
    const dmat4 turned =
        glm::scale(glm::rotate(glm::translate(dmat4(1), dvec3(5, 6, 7)), 0.5, glm::normalize(dvec3(1, 2, 3))),
                   dvec3(0.1, 0.2, 0.15));
    const PlacedBricks fog = placed(ball({20, 20, 20}), turned);
    const vec3 way(0.4f, -0.3f, 0.2f);
    const SparseVolume moved = moved_fog(fog,
                                         field_in(
                                             {0, 0, 0}, {40, 40, 40}, [&](vec3) { return way; }, turned),
                                         1, "fog");
    const auto bricks = make_bricks(moved);
    const vec3 center(turned * glm::dvec4(20, 20, 20, 1));
    for (const vec3 offset :
         {vec3(0.3f, 0, 0), vec3(0.2f, 0, 0.1f), vec3(-0.1f, 0.3f, 0)}) // beside the tip of the ball
        EXPECT_NEAR(sample_density(*bricks, center + way + offset), sample_density(*fog.bricks, center + offset), 0.02);
}

// Straight lines: what turns about an axis moves along the tangent, and so away from it.
TEST(MovedFog, GoesAlongTheVelocityThatItHas) {
    const float turn = 0.4f; // per unit of time
    const auto field = field_in({-40, -40, -8}, {40, 40, 8}, [&](vec3 p) { return turn * vec3(-p.y, p.x, 0); });
    const SparseVolume moved = moved_fog(placed(ball({20, 0, 0})), field, 1, "fog");
    const auto value = [&](vec3 y) { return std::max(1 - glm::distance(y, vec3(20, 0, 0)) / 6, 0.0f); };
    const mat3 map(vec3(1, turn, 0), vec3(-turn, 1, 0), vec3(0, 0, 1)); // by columns
    for (const vec3 y : {vec3(20, 0, 0), vec3(22, 1, 0), vec3(18, -2, 1)})
        EXPECT_NEAR(at(moved, map * y), value(y), 0.04);
}

TEST(MovedFog, StandsStillWhereNoVelocityIsKnown) {
    const PlacedBricks fog = placed(ball({20, 4, -30}));
    const SparseVolume moved =
        moved_fog(fog, field_in({200, 0, 0}, {210, 8, 8}, [](vec3) { return vec3(5); }), 1, "fog");
    EXPECT_NEAR(at(moved, {20, 4, -30}), 1, 1e-3);
    EXPECT_NEAR(mass_of(moved), mass_of(ball({20, 4, -30})), 1e-2);
}

TEST(MovedFog, AbsurdSpeedsAreOneLine) {
    const PlacedBricks fog = placed(ball({20, 4, -30}));
    for (const float speed : {1e6f, 1e30f, 3e38f}) {
        const auto field =
            field_in({13, -3, -37}, {28, 12, -22}, [&](vec3 p) { return vec3(p.x > 20 ? speed : 0, 0, 0); });
        EXPECT_THAT(error_message(ExitCode::refused, [&] { moved_fog(fog, field, 0.02, "medium smoke"); }),
                    HasSubstr("medium smoke: its velocity moves it by up to"))
            << speed;
    }
    const auto field = field_in({13, -3, -37}, {28, 12, -22}, [&](vec3 p) { return vec3(p.x, p.y, p.z) * 100.0f; });
    EXPECT_THAT(error_message(ExitCode::refused, [&] { moved_fog(fog, field, 0.7, "medium smoke"); }),
                HasSubstr("medium smoke"));
}

testing::AuthoredGrid grid_of(const std::string& name, const std::string& type,
                              const std::string& grid_class = "unknown") {
    testing::AuthoredGrid grid;
    grid.name = name, grid.type = type, grid.grid_class = grid_class;
    return grid;
}

VelocityField read_field(const std::vector<testing::AuthoredGrid>& grids, const std::vector<std::string>& names,
                         VdbReadReport* report = nullptr, const ValueMap& map = {}) {
    const TempFolder scratch;
    return make_velocity_field(read_velocity_vdb(scratch.put("in.vdb", testing::authored(grids)), names, map, report));
}

// v = a + b·p, which straight lines between voxels hold, wherever in the voxel each component is kept.
TEST(VelocityGrids, StaggeredOnesLieOnTheFacesOfTheirVoxels) {
    const vec3 a(1, -2, 3), b(0.5f, 0.25f, -1);
    for (const bool staggered : {false, true}) {
        testing::AuthoredGrid grid = grid_of("v", "vec3s", staggered ? "staggered" : "unknown");
        for (int i = 0; i < 1000; ++i) {
            const ivec3 voxel(i / 100, i / 10 % 10, i % 10);
            grid.colors.emplace_back(voxel, a + b * (vec3(voxel) - (staggered ? 0.5f : 0.0f)));
        }
        const LocalVelocity velocity(read_field({grid}, {"v"}), dmat4(1));
        for (const vec3 point : {vec3(4), vec3(3.25f, 4.5f, 5.75f), vec3(1, 7, 2)}) {
            vec3 v;
            ASSERT_TRUE(velocity.at(point, v));
            expect_near(v, a + b * point, 0.01f);
        }
    }
}

TEST(VelocityGrids, MayBeThreeOfNumbers) {
    std::vector<testing::AuthoredGrid> grids;
    for (const char* name : {"vel.x", "vel.y", "vel.z"}) {
        grids.push_back(grid_of(name, "float"));
        for (int i = 0; i < 64; ++i)
            grids.back().voxels.emplace_back(ivec3(i / 16, i / 4 % 4, i % 4), static_cast<float>(name[4] - 'w') * -2);
    }
    for (const std::vector<std::string>& names : {std::vector<std::string>{"vel"}, {"vel.x", "vel.y", "vel.z"}}) {
        vec3 v;
        ASSERT_TRUE(LocalVelocity(read_field(grids, names), dmat4(1)).at(vec3(1.5f), v));
        expect_near(v, vec3(-2, -4, -6), 1e-3f);
    }
    EXPECT_THAT(error_message(ExitCode::refused, [&] { read_field(grids, {"vel.x"}); }),
                HasSubstr("one number per voxel"));
}

// A simulation in two dimensions leaves one of the three grids empty, and others prune what is 0.
TEST(VelocityGrids, AComponentIs0WhereOnlyOthersAreKnown) {
    std::vector<testing::AuthoredGrid> grids;
    for (const char* name : {"vel.x", "vel.y", "vel.z"}) grids.push_back(grid_of(name, "float"));
    for (int i = 0; i < 8 * 8 * 16; ++i) {
        const ivec3 voxel(i / 128, i / 16 % 8, i % 16);
        grids[1].voxels.emplace_back(voxel, -4.0f);
        if (voxel.z >= 10) grids[2].voxels.emplace_back(voxel, voxel.z < 12 ? 5.0f : 6.0f);
    }
    for (const float shift : {0.0f, 9.0f}) { // an empty grid lies nowhere
        grids[0].index_to_world[3][0] = double{shift};
        const LocalVelocity velocity(read_field(grids, {"vel"}), dmat4(1));
        for (const vec2 known : {vec2(4, 0), vec2(9, 0), vec2(9.5f, 2.5f), vec2(10, 5), vec2(13, 6)}) {
            vec3 v;
            ASSERT_TRUE(velocity.at(vec3(4, 4, known.x), v)) << known.x;
            expect_near(v, vec3(0, -4, known.y), 0.01f);
        }
    }
    grids[2].voxels.clear(), grids[1].voxels.clear();
    EXPECT_EQ(read_field(grids, {"vel"}).fastest, 0);
}

TEST(VelocityGrids, WhatIsNotFiniteIsSetTo0AndSaid) {
    testing::AuthoredGrid grid = grid_of("vel", "vec3s");
    for (int i = 0; i < 64; ++i) grid.colors.emplace_back(ivec3(i / 16, i / 4 % 4, i % 4), vec3(3));
    grid.colors[0].second = vec3(std::nanf(""), 3, infinity), grid.colors[9].second = vec3(1e30f, -1e30f, 0);
    VdbReadReport report;
    ValueMap map;
    map.clamp = {-20, 20};
    const VelocityField field = read_field({grid}, {"vel"}, &report, map);
    EXPECT_THAT(report.summary(), HasSubstr("grid \"vel\": 2 non-finite voxels set to 0"));
    EXPECT_LE(field.fastest, std::sqrt(3.0f) * 20);
    vec3 v;
    ASSERT_TRUE(LocalVelocity(field, dmat4(1)).at(vec3(3), v));
    expect_near(v, vec3(3), 0.02f);
}

TEST(VelocityGrids, EmptyOnesMoveNothing) {
    VdbReadReport report;
    EXPECT_EQ(read_field({grid_of("vel", "vec3s")}, {"vel"}, &report).fastest, 0);
    EXPECT_THAT(report.summary(), HasSubstr("is empty"));
}

TEST(BlendedFog, IsTheMeanOfTwoFrames) {
    const SparseVolume a = volume_of(ivec3(-3), ivec3(12), exact_noise), b = ball({10, 10, 10});
    const SparseVolume mixed = blended_fog(placed(a), placed(b), 0.25f, "fog");
    for (int i = -4; i < 20; ++i)
        for (int j = -4; j < 20; ++j)
            ASSERT_NEAR(testing::value_at(mixed, {i, j, 8}),
                        0.75f * testing::value_at(a, {i, j, 8}) + 0.25f * testing::value_at(b, {i, j, 8}), 1e-3f);
}

TEST(BlendedFog, TakesTheFinerVoxelsAndWhatIsNotThereAsNothing) {
    const dmat4 fine = glm::scale(dmat4(1), dvec3(0.5));
    const PlacedBricks coarse = placed(ball({10, 10, 10})), small = placed(ball({20, 20, 20}), fine);
    const SparseVolume mixed = blended_fog(coarse, small, 0.5f, "fog");
    EXPECT_EQ(mixed.index_to_world, fine);
    const auto bricks = make_bricks(mixed);
    for (const vec3 point : {vec3(10), vec3(12, 10, 9), vec3(6, 11, 10)})
        EXPECT_NEAR(sample_density(*bricks, point),
                    0.5f * sample_density(*coarse.bricks, point) + 0.5f * sample_density(*small.bricks, point), 0.01f);
    const SparseVolume fading = blended_fog(coarse, {}, 0.75f, "fog"), coming = blended_fog({}, coarse, 0.75f, "fog");
    EXPECT_NEAR(at(fading, {10, 10, 10}), 0.25f, 1e-3f);
    EXPECT_NEAR(at(coming, {10, 10, 10}), 0.75f, 1e-3f);
    EXPECT_TRUE(blended_fog({}, {}, 0.5f, "fog").empty());
}

TEST(BlendedFog, ConstantPartsStayTiles) {
    SparseVolume volume;
    volume.active_low = ivec3(0), volume.active_high = ivec3(799);
    volume.tiles = {{ivec3(0), ivec3(799), 0.5f}};
    const PlacedBricks large = placed(volume);
    const SparseVolume mixed = blended_fog(large, large, 0.5f, "fog");
    EXPECT_LT(mixed.leaves.size(), 70'000u); // of 10^6: the faces
    EXPECT_EQ(testing::value_at(mixed, {400, 400, 400}), 0.5f);
}
}
}

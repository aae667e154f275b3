// Volumes written by Houdini, Blender, Bifrost and others: each is read as what it is, or refused in one line.
#include "support/corpus.h"
#include "volume/vdb/vdb.h"
#include "volume/vdb/vdb_fixtures.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace tyndall {
namespace {
using namespace testing;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

fs::path vdb(const std::string& name) { return test::corpus_file("vdb/" + name); }

struct Read {
    SparseVolume volume;
    VdbReadReport report;
    double sum = 0;
    float maximum = 0;
};

Read read(const fs::path& file, const std::string& grid = "") {
    Read result;
    result.volume = read_vdb(file, grid, &result.report);
    for (const Leaf& leaf : result.volume.leaves)
        for (const float value : leaf.values) {
            EXPECT_TRUE(value >= 0 && std::isfinite(value));
            result.sum += static_cast<double>(value), result.maximum = std::max(result.maximum, value);
        }
    for (const Tile& tile : result.volume.tiles) {
        const ivec3 size = tile.high - tile.low + 1;
        result.sum += static_cast<double>(tile.value) * size.x * size.y * size.z;
    }
    return result;
}

TEST(VdbCorpus, EveryFileReadsOrIsRefusedInOneLine) {
    int files = 0, readable = 0;
    for (const fs::path& file : test::corpus_files("vdb")) {
        ++files;
        const Error info = error_of([&] { vdb_info(file); });
        const Error read = error_of([&] { read_vdb(file); });
        readable += read.code == ExitCode::ok;
        for (const Error* error : {&info, &read}) {
            EXPECT_TRUE(error->code == ExitCode::ok || error->code == ExitCode::refused) << file;
            EXPECT_LE(std::strlen(error->what()), 500u);
            EXPECT_EQ(std::strchr(error->what(), '\n'), nullptr);
            if (error->code == ExitCode::ok) continue;
            EXPECT_THAT(error->what(), HasSubstr(file.filename().string()));
        }
    }
    EXPECT_GE(files, 16);
    EXPECT_GE(readable, 7);
}

TEST(VdbCorpus, CutFilesAreRefused) {
    const TempFolder scratch;
    for (const fs::path& file : test::corpus_files_named(
             {"vdb/vpt/dragon.vdb", "vdb/oiio/sphere.vdb", "vdb/helium/smoke.vdb", "vdb/openusd/densityAndHeat.vdb"})) {
        const std::string good = bytes_of(file);
        for (size_t i = 0; i < 40; ++i) {
            const auto cut = scratch.put("cut.vdb", good.substr(0, good.size() * (i + 1) / 40 - 1));
            EXPECT_EQ(error_of([&] { read_vdb(cut); }).code, ExitCode::refused) << file << ' ' << i;
        }
    }
}

struct Known {
    std::string file, grid;
    uint64_t active_voxels;
    float voxel, maximum;
};

// What the programs say that wrote the files.
void expect_known(const std::vector<Known>& grids) {
    std::vector<std::string> names;
    for (const Known& known : grids) names.push_back("vdb/" + known.file);
    for (const fs::path& file : test::corpus_files_named(names)) {
        const auto known = std::ranges::find_if(grids, [&](const Known& k) { return file.string().ends_with(k.file); });
        const VdbInfo info = vdb_info(file);
        const auto grid = std::ranges::find(info.grids, known->grid, &VdbGridInfo::name);
        ASSERT_NE(grid, info.grids.end()) << file;
        EXPECT_EQ(grid->active_voxels, known->active_voxels) << file;
        EXPECT_NEAR(grid->voxel_size.x, known->voxel, 1e-4f * known->voxel) << file;
        const Read back = read(file, known->grid);
        EXPECT_NEAR(back.maximum, known->maximum, 1e-4f * known->maximum) << file;
        EXPECT_NEAR(back.sum, grid->mean * static_cast<double>(grid->active_voxels), 1e-4 * back.sum) << file;
    }
}

TEST(VdbCorpus, LargeCloud) {
    expect_known({{"vpt/dragon_with_xform.vdb", "density", 156161, 0.12f, 1},
                  {"wdas/wdas_cloud_sixteenth.vdb", "density", 415642, 3.33333f, 1}});
}

TEST(VdbCorpus, HalfFloats) {
    expect_known({{"volumarcher/nebula_cut.vdb", "color.x", 11990, 0.05f, 0.306396f},
                  {"helium/smoke.vdb", "density", 1049275, 0.47619f, 5.71484f}});
}

TEST(VdbCorpus, LevelSetsAreRefusedWithAHint) {
    for (const fs::path& file : test::corpus_files_named(
             {"vdb/volumarcher/nebula_cut.vdb", "vdb/cortex/sphere.vdb", "vdb/openvdb-website/icosahedron.vdb"})) {
        const bool several = file.filename() == "nebula_cut.vdb";
        const Error error = error_of([&] { read(file, several ? "distance" : ""); });
        EXPECT_EQ(error.code, ExitCode::refused);
        EXPECT_THAT(error.what(), HasSubstr("ls2fog"));
    }
}

TEST(VdbCorpus, PointsAreRefused) {
    for (const fs::path& file : test::corpus_files_named({"vdb/arnold/pointgrid.vdb", "vdb/cortex/points.vdb"}))
        EXPECT_THAT(error_of([&] { read(file); }).what(), HasSubstr("ptdataidx32"));
}

TEST(VdbCorpus, ThreeGridsOfOneName) {
    const fs::path file = vdb("arnold/grids.vdb");
    const VdbInfo info = vdb_info(file);
    ASSERT_EQ(info.grids.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(info.grids[i].name, "density");
        EXPECT_EQ(info.grids[i].key, "density[" + std::to_string(i) + "]");
        EXPECT_EQ(read(file, info.grids[i].key).volume.index_to_world, info.grids[i].index_to_world);
    }
    // They stand in the file as x = 0 comes last.
    std::vector<double> x;
    for (const char* grid : {"density[0]", "density[1]", "density[2]"})
        x.push_back(read(file, grid).volume.index_to_world[3][0]);
    EXPECT_EQ(read(file).volume.index_to_world[3][0], x[0]);
    std::ranges::sort(x);
    EXPECT_THAT(x, ::testing::ElementsAre(0, 2, 4));
    EXPECT_THAT(error_of([&] { read(file, "density[3]"); }).what(),
                HasSubstr("density[0] (float), density[1] (float)"));
}

TEST(VdbCorpus, GridNotNamedDensity) {
    const Read torus = read(vdb("arnold/torus01.vdb"));
    EXPECT_EQ(torus.report.grid, "voxel_fog_density");
    EXPECT_EQ(torus.maximum, 100);
}

// Boxes of ones.
TEST(VdbCorpus, TilesAndLeavesFillABox) {
    for (const fs::path& file : test::corpus_files_named({"vdb/vpt/box.vdb", "vdb/hsim/writer.vdb"})) {
        const bool small = file.filename() == "box.vdb";
        const Read box = read(file, small ? "" : "temperature");
        EXPECT_EQ(box.volume.active_low, ivec3(small ? -10 : -50));
        EXPECT_EQ(box.volume.active_high, ivec3(small ? 10 : 49));
        EXPECT_FALSE(box.volume.tiles.empty());
        EXPECT_EQ(box.sum, small ? 9261 : 1e6);
    }
}

TEST(VdbCorpus, BackgroundOfOne) {
    const Read box = read(vdb("vpt/box.vdb"));
    EXPECT_EQ(box.report.background, 1);
    for (int i = -16; i <= 16; ++i) EXPECT_EQ(value_at(box.volume, {i, 0, 0}), std::abs(i) <= 10 ? 1 : 0) << i;
}

// Two frames as Blender writes them: nothing yet but its grids, then smoke in cells that are not cubes.
void expect_smoke_from_nothing(const fs::path& first_file, const fs::path& second_file) {
    const Read first = read(first_file);
    EXPECT_TRUE(first.volume.empty());
    EXPECT_THAT(first.report.summary(), HasSubstr("empty"));
    const Read second = read(second_file);
    EXPECT_EQ(second.volume.index_to_world, first.volume.index_to_world);
    EXPECT_NE(second.volume.index_to_world[0][0], second.volume.index_to_world[2][2]);
    EXPECT_GT(second.sum, 1);
    EXPECT_THAT(error_of([&] { read(first_file, "obstacles"); }).what(), HasSubstr("int32"));
    EXPECT_THAT(error_of([&] { read(first_file, "velocity"); }).what(), HasSubstr("vec3s"));
}

TEST(VdbCorpus, EmptyFrameOfASequence) {
    std::vector<AuthoredGrid> grids(4);
    grids[1].name = "heat";
    grids[2].name = "obstacles", grids[2].type = "int32";
    grids[3].name = "velocity", grids[3].type = "vec3s";
    for (AuthoredGrid& grid : grids) grid.index_to_world = glm::scale(dmat4(1), dvec3(0.1326, 0.1329, 0.1317));
    AuthoredGrid smoke = noisy_ball(ivec3(20), 6);
    smoke.index_to_world = grids[0].index_to_world;
    const TempFolder scratch;
    expect_smoke_from_nothing(scratch.put("1.vdb", authored(grids)), scratch.put("2.vdb", authored({smoke})));
    for (const fs::path& file : test::corpus_files("vdb"))
        if (file.filename() == "smoke_000001.vdb")
            expect_smoke_from_nothing(file, file.parent_path() / "smoke_000002.vdb");
}

TEST(VdbCorpus, RotatedTransform) {
    const dmat4 matrix = read(vdb("vpt/dragon_with_xform.vdb")).volume.index_to_world;
    EXPECT_NEAR(glm::length(dvec3(matrix[0])), 0.12, 1e-3);
    EXPECT_GT(std::abs(matrix[0][1]) + std::abs(matrix[0][2]) + std::abs(matrix[1][2]), 1e-3);
}

TEST(VdbCorpus, FogBesideADistanceField) {
    const fs::path nebula = vdb("volumarcher/nebula_cut.vdb");
    EXPECT_EQ(read(nebula).report.grid, "density");
    EXPECT_THAT(error_of([&] { read(nebula, "distance"); }).what(), HasSubstr("level set"));
    EXPECT_EQ(read(nebula, "color.y").report.negative, 6230u);
}

TEST(VdbCorpus, ActiveVoxelsOfNothing) {
    AuthoredGrid nothing;
    nothing.voxels = {{ivec3(0), 0.0f}, {ivec3(9), 0.0f}};
    const TempFolder scratch;
    const Read back = read(scratch.put("nothing.vdb", authored({nothing})));
    EXPECT_FALSE(back.volume.empty());
    EXPECT_EQ(back.sum, 0);
}

TEST(VdbCorpus, WhatIsNoVolume) {
    EXPECT_THAT(error_of([&] { read(vdb("malformed/git-lfs-pointer.vdb")); }).what(), HasSubstr("git lfs pull"));
    EXPECT_THAT(error_of([&] { read(vdb("nanovdb/teapot_cloud_start.nvdb")); }).what(), HasSubstr("is truncated"));
    EXPECT_THAT(error_of([&] { read(vdb("malformed/oiio-189fe477e/truncated.vdb")); }).what(),
                HasSubstr("is truncated"));
}

// What was read, written and read again is the same fog.
TEST(VdbCorpus, RoundTrip) {
    const TempFolder scratch;
    for (const fs::path& file : test::corpus_files_named(
             {"vdb/vpt/dragon_with_xform.vdb", "vdb/vpt/box.vdb", "vdb/openusd/smoke_000003.vdb"})) {
        const Read once = read(file);
        ASSERT_FALSE(once.volume.leaves.empty());
        write_vdb(scratch.path() / "a.vdb", once.volume, {.half = false});
        VdbReadReport report;
        const SparseVolume again = read_vdb(scratch.path() / "a.vdb", "", &report);
        EXPECT_EQ(report.summary(), "");
        EXPECT_EQ(again.index_to_world, once.volume.index_to_world);
        for (const Leaf& leaf : once.volume.leaves)
            for (int v = 0; v < 512; v += 37)
                ASSERT_EQ(value_at(again, leaf.origin + ivec3(v >> 6, v >> 3 & 7, v & 7)),
                          leaf.values[static_cast<size_t>(v)]);
    }
}
}
}

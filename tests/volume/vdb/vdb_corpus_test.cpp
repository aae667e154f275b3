// Volumes written by Houdini, Blender, Bifrost and others: each is read as what it is, or refused in one line.
#include "volume/vdb/vdb.h"
#include "volume/vdb/vdb_fixtures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace tyndall {
namespace {
using namespace testing;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path corpus = fs::path(TYNDALL_SHARED_DATA) / "vdb";

class VdbCorpus : public ::testing::Test {
protected:
    void SetUp() override {
        if (!fs::is_directory(corpus)) GTEST_SKIP() << "no volumes in " << corpus;
    }
};

struct Read {
    SparseVolume volume;
    VdbReadReport report;
    double sum = 0;
    float maximum = 0;
};

Read read(const std::string& name, const std::string& grid = "") {
    Read result;
    result.volume = read_vdb(corpus / name, grid, &result.report);
    for (const Leaf& leaf : result.volume.leaves)
        for (const float value : leaf.values) {
            EXPECT_TRUE(value >= 0 && std::isfinite(value));
            result.sum += static_cast<double>(value), result.maximum = std::max(result.maximum, value);
        }
    return result;
}

TEST_F(VdbCorpus, EveryFileReadsOrIsRefusedInOneLine) {
    int files = 0, readable = 0;
    for (const auto& entry : fs::recursive_directory_iterator(corpus)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        const Error info = error_of([&] { vdb_info(entry.path()); });
        const Error read = error_of([&] { read_vdb(entry.path()); });
        readable += read.code == ExitCode::ok;
        for (const Error* error : {&info, &read}) {
            EXPECT_TRUE(error->code == ExitCode::ok || error->code == ExitCode::refused) << entry.path();
            EXPECT_LE(std::strlen(error->what()), 500u);
            EXPECT_EQ(std::strchr(error->what(), '\n'), nullptr);
            if (error->code == ExitCode::ok) continue;
            EXPECT_THAT(error->what(), HasSubstr(entry.path().filename().string()));
        }
    }
    EXPECT_GE(files, 30);
    EXPECT_GE(readable, 20);
}

TEST_F(VdbCorpus, CutFilesAreRefused) {
    const Scratch scratch;
    for (const char* name : {"vpt/dragon.vdb", "helium/smoke.vdb", "openusd/densityAndHeat.vdb", "oiio/sphere.vdb"}) {
        const std::string good = bytes_of(corpus / name);
        for (size_t i = 0; i < 40; ++i) {
            const auto file = scratch.put("cut.vdb", good.substr(0, good.size() * (i + 1) / 40 - 1));
            EXPECT_EQ(error_of([&] { read_vdb(file); }).code, ExitCode::refused) << name << ' ' << i;
        }
    }
}

TEST_F(VdbCorpus, LargeCloud) {
    const VdbGridInfo info = vdb_info(corpus / "wdas/wdas_cloud_sixteenth.vdb").grids.at(0);
    EXPECT_EQ(info.active_voxels, 415642u);
    EXPECT_NEAR(info.voxel_size.x, 3.3333f, 1e-3f);
    EXPECT_EQ(info.maximum, 1);
    const Read cloud = read("wdas/wdas_cloud_sixteenth.vdb");
    double sum = cloud.sum;
    for (const Tile& tile : cloud.volume.tiles) {
        const ivec3 size = tile.high - tile.low + 1;
        sum += static_cast<double>(tile.value) * size.x * size.y * size.z;
    }
    EXPECT_NEAR(sum, info.mean * static_cast<double>(info.active_voxels), 1e-4 * sum);
}

TEST_F(VdbCorpus, HalfFloats) {
    const Read smoke = read("helium/smoke.vdb");
    EXPECT_NEAR(smoke.maximum, 5.715f, 1e-3f);
    EXPECT_NEAR(smoke.volume.index_to_world[0][0], 0.47619, 1e-5);
    EXPECT_EQ(vdb_info(corpus / "helium/smoke.vdb").grids.at(0).active_voxels, 1049275u);
}

TEST_F(VdbCorpus, LevelSetsAreRefusedWithAHint) {
    for (const char* name : {"cortex/sphere.vdb", "openvdb-website/icosahedron.vdb"}) {
        const Error error = error_of([&] { read(name); });
        EXPECT_EQ(error.code, ExitCode::refused);
        EXPECT_THAT(error.what(), HasSubstr("ls2fog"));
    }
}

TEST_F(VdbCorpus, PointsAreRefused) {
    for (const char* name : {"cortex/points.vdb", "arnold/pointgrid.vdb"})
        EXPECT_THAT(error_of([&] { read(name); }).what(), HasSubstr("ptdataidx32"));
}

TEST_F(VdbCorpus, ThreeGridsOfOneName) {
    const VdbInfo info = vdb_info(corpus / "arnold/grids.vdb");
    ASSERT_EQ(info.grids.size(), 3u);
    for (const VdbGridInfo& grid : info.grids) EXPECT_EQ(grid.name, "density");
    // They stand in the file as x = 0 comes last.
    std::vector<double> x;
    for (const char* grid : {"density[0]", "density[1]", "density[2]"})
        x.push_back(read("arnold/grids.vdb", grid).volume.index_to_world[3][0]);
    EXPECT_EQ(read("arnold/grids.vdb").volume.index_to_world[3][0], x[0]);
    std::ranges::sort(x);
    EXPECT_THAT(x, ::testing::ElementsAre(0, 2, 4));
    EXPECT_THAT(error_of([&] { read("arnold/grids.vdb", "density[3]"); }).what(),
                HasSubstr("density (float), density (float)"));
}

TEST_F(VdbCorpus, GridNotNamedDensity) {
    const Read torus = read("arnold/torus01.vdb");
    EXPECT_EQ(torus.report.grid, "voxel_fog_density");
    EXPECT_EQ(torus.maximum, 100);
    EXPECT_EQ(read("hsim/writer.vdb").report.grid, "temperature");
}

TEST_F(VdbCorpus, TilesAndLeavesFillABox) {
    const Read box = read("hsim/writer.vdb"); // 100³ voxels of 1
    EXPECT_EQ(box.volume.active_low, ivec3(-50));
    EXPECT_EQ(box.volume.active_high, ivec3(49));
    double sum = box.sum;
    for (const Tile& tile : box.volume.tiles) {
        const ivec3 size = tile.high - tile.low + 1;
        sum += static_cast<double>(tile.value) * size.x * size.y * size.z;
    }
    EXPECT_EQ(sum, 1e6);
}

TEST_F(VdbCorpus, BackgroundOfOne) {
    const Read box = read("vpt/box.vdb");
    EXPECT_EQ(box.report.background, 1);
    EXPECT_EQ(box.volume.active_low, ivec3(-10));
    EXPECT_EQ(box.volume.active_high, ivec3(10));
    for (int i = -16; i <= 16; ++i) EXPECT_EQ(value_at(box.volume, {i, 0, 0}), std::abs(i) <= 10 ? 1 : 0) << i;
}

TEST_F(VdbCorpus, EmptyFrameOfASequence) {
    const Read first = read("openusd/smoke_000001.vdb");
    EXPECT_TRUE(first.volume.empty());
    EXPECT_THAT(first.report.summary(), HasSubstr("empty"));
    const Read second = read("openusd/smoke_000002.vdb");
    EXPECT_EQ(second.volume.index_to_world, first.volume.index_to_world); // cells that are not cubes
    EXPECT_NE(second.volume.index_to_world[0][0], second.volume.index_to_world[2][2]);
    EXPECT_GT(second.sum, 1);
    EXPECT_THAT(error_of([&] { read("openusd/smoke_000001.vdb", "obstacles"); }).what(), HasSubstr("int32"));
    EXPECT_THAT(error_of([&] { read("openusd/smoke_000001.vdb", "velocity"); }).what(), HasSubstr("vec3s"));
}

TEST_F(VdbCorpus, RotatedTransform) {
    const dmat4 matrix = read("vpt/dragon_with_xform.vdb").volume.index_to_world;
    EXPECT_NEAR(glm::length(dvec3(matrix[0])), 0.12, 1e-3);
    EXPECT_GT(std::abs(matrix[0][1]) + std::abs(matrix[0][2]) + std::abs(matrix[1][2]), 1e-3);
}

TEST_F(VdbCorpus, FogBesideADistanceField) {
    EXPECT_EQ(read("volumarcher/singlecloud.vdb").report.grid, "density");
    EXPECT_EQ(read("volumarcher/nebula.vdb").report.grid, "density");
    EXPECT_THAT(error_of([&] { read("volumarcher/nebula.vdb", "distance"); }).what(), HasSubstr("level set"));
    EXPECT_EQ(read("volumarcher/nebula.vdb", "color.y").report.negative, 34364u);
}

TEST_F(VdbCorpus, ActiveVoxelsOfNothing) {
    const Read sphere = read("tinyvdbio/sphere-div1.vdb");
    EXPECT_FALSE(sphere.volume.empty());
    EXPECT_EQ(sphere.sum, 0);
}

TEST_F(VdbCorpus, WhatIsNoVolume) {
    EXPECT_THAT(error_of([&] { read("malformed/git-lfs-pointer.vdb"); }).what(), HasSubstr("git lfs pull"));
    EXPECT_THAT(error_of([&] { read("nanovdb/teapot_cloud-RENDER-0.85.nvdb"); }).what(), HasSubstr("nanovdb_convert"));
    EXPECT_THAT(error_of([&] { read("malformed/oiio-189fe477e/truncated.vdb"); }).what(), HasSubstr("is cut"));
}

// What was read, written and read again is the same fog.
TEST_F(VdbCorpus, RoundTrip) {
    const Scratch scratch;
    for (const char* name : {"vpt/dragon_with_xform.vdb", "vpt/box.vdb", "openusd/smoke_000003.vdb"}) {
        const Read once = read(name);
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

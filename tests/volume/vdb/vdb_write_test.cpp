#include "support/threads.h"
#include "volume/vdb/vdb.h"
#include "volume/vdb/vdb_fixtures.h"

#include <gtest/gtest.h>

#include <sys/mount.h>
#include <sys/resource.h>

#include <csignal>
#include <random>

namespace tyndall {
namespace {
using namespace testing;

SparseVolume example(dmat4 index_to_world = dmat4(0.25)) {
    SparseVolume volume;
    volume.index_to_world = index_to_world;
    volume.index_to_world[3][3] = 1;
    volume.metadata = {{"tyndall_frame", "12"}, {"tyndall_g", "0.3"}, {"tyndall_settings_hash", "00ff"}, {"note", "1"}};
    std::mt19937 random(7);
    for (const ivec3 origin : {ivec3(0, 0, 0), ivec3(8, 0, 0), ivec3(-8, -16, 4088), ivec3(-4104, 8, 8)}) {
        Leaf leaf;
        leaf.origin = origin;
        for (float& value : leaf.values)
            if (random() % 4) value = static_cast<float>(random() % 2048) / 1024; // exact in half
        leaf.values[0] = 1;
        leaf.values[511] = 0.5f;
        volume.leaves.push_back(leaf);
    }
    volume.tiles.push_back({ivec3(128), ivec3(255), 0.75f});
    return volume;
}

void expect_same_fog(const SparseVolume& a, const SparseVolume& b) {
    for (const SparseVolume* from : {&a, &b})
        for (const Leaf& leaf : from->leaves)
            for (int v = 0; v < 512; ++v) {
                const ivec3 at = leaf.origin + ivec3(v >> 6, v >> 3 & 7, v & 7);
                ASSERT_EQ(value_at(a, at), value_at(b, at)) << at.x << ' ' << at.y << ' ' << at.z;
            }
}

struct Encoding {
    bool half, blosc;
};

class WriteEncodings : public ::testing::TestWithParam<Encoding> {};

TEST_P(WriteEncodings, ReadBackTheSame) {
    const TempFolder scratch;
    const SparseVolume volume = example();
    write_vdb(scratch.path() / "a.vdb", volume, {.half = GetParam().half, .blosc = GetParam().blosc});
    VdbReadReport report;
    const SparseVolume back = read_vdb(scratch.path() / "a.vdb", "", &report);
    EXPECT_EQ(report.summary(), "");
    EXPECT_EQ(back.name, "density");
    EXPECT_EQ(back.index_to_world, volume.index_to_world);
    EXPECT_EQ(back.active_low, ivec3(-4104, -16, 0));
    EXPECT_EQ(back.active_high, ivec3(255, 255, 4095));
    EXPECT_EQ(value_at(back, ivec3(200)), 0.75f);
    expect_same_fog(volume, back);

    const VdbInfo info = vdb_info(scratch.path() / "a.vdb");
    ASSERT_EQ(info.grids.size(), 1u);
    EXPECT_EQ(info.grids[0].type, "float");
    EXPECT_EQ(info.grids[0].grid_class, "fog volume");
    EXPECT_EQ(info.grids[0].background, 0);
    EXPECT_EQ(info.compression, GetParam().blosc ? "blosc + active values" : "zip + active values");
}

TEST_P(WriteEncodings, SameInputSameBytes) {
    const TempFolder scratch;
    SparseVolume volume = example();
    const VdbWriteOptions options{.half = GetParam().half, .blosc = GetParam().blosc};
    write_vdb(scratch.path() / "a.vdb", volume, options);
    std::ranges::reverse(volume.leaves);
    on_threads(1, [&] { write_vdb(scratch.path() / "b.vdb", volume, options); });
    const std::string a = bytes_of(scratch.path() / "a.vdb");
    EXPECT_EQ(a, bytes_of(scratch.path() / "b.vdb"));

    // Different content gets a different identity.
    volume.leaves[0].values[5] += 0.5f;
    write_vdb(scratch.path() / "b.vdb", volume, options);
    EXPECT_NE(a.substr(21, 36), bytes_of(scratch.path() / "b.vdb").substr(21, 36));
}

INSTANTIATE_TEST_SUITE_P(All, WriteEncodings,
                         ::testing::Values(Encoding{true, true}, Encoding{true, false}, Encoding{false, true},
                                           Encoding{false, false}));

TEST(VdbWrite, ShearedTransformSurvives) {
    const TempFolder scratch;
    dmat4 matrix(0.5);
    matrix[1][0] = 0.125, matrix[2][1] = -0.25, matrix[3] = glm::dvec4(1, 2, 3, 1);
    write_vdb(scratch.path() / "a.vdb", example(matrix));
    EXPECT_EQ(read_vdb(scratch.path() / "a.vdb").index_to_world, matrix);
}

TEST(VdbWrite, MetadataSurvives) {
    const TempFolder scratch;
    write_vdb(scratch.path() / "a.vdb", example(), {.creator = "someone"});
    const std::vector<std::pair<std::string, std::string>> expected = {{"creator", "someone"},
                                                                       {"note", "1"},
                                                                       {"tyndall_frame", "12"},
                                                                       {"tyndall_g", "0.3"},
                                                                       {"tyndall_settings_hash", "00ff"}};
    EXPECT_EQ(vdb_metadata(scratch.path() / "a.vdb"), expected);
    EXPECT_EQ(read_vdb(scratch.path() / "a.vdb").metadata, expected);
}

TEST(VdbWrite, ValuesThatDoNotFitAreClamped) {
    const TempFolder scratch;
    SparseVolume volume;
    volume.leaves.resize(1);
    volume.leaves[0].values = {65520, infinity, -1, std::nanf(""), 1e-8f, 0.1f};
    write_vdb(scratch.path() / "half.vdb", volume);
    const SparseVolume half = read_vdb(scratch.path() / "half.vdb");
    EXPECT_EQ(value_at(half, {0, 0, 0}), 65504);
    EXPECT_EQ(value_at(half, {0, 0, 1}), 65504);
    for (int z = 2; z <= 4; ++z) EXPECT_EQ(value_at(half, {0, 0, z}), 0);
    EXPECT_NEAR(value_at(half, {0, 0, 5}), 0.1f, 0.1f / 2048);
    EXPECT_EQ(vdb_info(scratch.path() / "half.vdb").grids[0].active_voxels, 3u); // zero voxels are inactive

    write_vdb(scratch.path() / "float.vdb", volume, {.half = false});
    EXPECT_EQ(value_at(read_vdb(scratch.path() / "float.vdb"), {0, 0, 4}), 1e-8f);
}

TEST(VdbWrite, EmptyVolume) {
    const TempFolder scratch;
    SparseVolume volume;
    volume.leaves.resize(2);
    volume.leaves[1].origin = ivec3(8);
    write_vdb(scratch.path() / "a.vdb", volume);
    VdbReadReport report;
    EXPECT_TRUE(read_vdb(scratch.path() / "a.vdb", "", &report).empty());
    EXPECT_TRUE(report.empty);
}

// A file size limit fails a write as a full disk does, in the middle and not at open.
TEST(VdbWrite, FailedWriteLeavesNothing) {
    const TempFolder scratch;
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 2048;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const Error error = error_of([&] { write_vdb(scratch.path() / "a.vdb", example()); });
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(error.code, ExitCode::unwritable) << error.what();
    EXPECT_TRUE(scratch.names().empty());
}

TEST(VdbWrite, FullDiskLeavesTheOldFile) {
    const TempFolder scratch;
    if (mount("tmpfs", scratch.path().c_str(), "tmpfs", 0, "size=128k") != 0)
        GTEST_SKIP() << "cannot mount a small disk";
    SparseVolume large = example();
    for (int i = 1; i < 80; ++i) {
        large.leaves.push_back(large.leaves[0]);
        large.leaves.back().origin = ivec3(8 * i, 8, 0);
    }
    write_vdb(scratch.path() / "a.vdb", example());
    const std::string old = bytes_of(scratch.path() / "a.vdb");
    const Error error = error_of([&] { write_vdb(scratch.path() / "a.vdb", large, {.half = false}); });
    const std::string now = bytes_of(scratch.path() / "a.vdb");
    const auto files = std::distance(std::filesystem::directory_iterator(scratch.path()), {});
    umount(scratch.path().c_str());
    EXPECT_EQ(error.code, ExitCode::unwritable) << error.what();
    EXPECT_TRUE(old == now && !old.empty());
    EXPECT_EQ(files, 1);
}
}
}

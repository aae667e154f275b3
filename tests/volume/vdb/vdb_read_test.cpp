// Grids as other programs write them: read with the library's meaning, or refused by name.
#include "volume/vdb/vdb.h"
#include "volume/vdb/vdb_fixtures.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <atomic>
#include <thread>

namespace tyndall {
namespace {
using namespace testing;
using ::testing::HasSubstr;

struct Read {
    SparseVolume volume;
    VdbReadReport report;
};

Read read(const std::string& bytes, const std::string& grid = "") {
    const TempFolder scratch;
    Read result;
    result.volume = read_vdb(scratch.put("in.vdb", bytes), grid, &result.report);
    return result;
}

Error refusal(const std::string& bytes, const std::string& grid = "") {
    return error_of([&] { read(bytes, grid); });
}

AuthoredGrid small(const std::string& name, const std::string& type = "float", const std::string& grid_class = "") {
    AuthoredGrid grid;
    grid.name = name, grid.type = type, grid.grid_class = grid_class;
    grid.voxels = {{ivec3(1, 2, 3), 1.0f}};
    return grid;
}

struct Stored {
    std::string type;
    bool half;
    uint32_t packing;
    bool offsets;
};

class ReadStored : public ::testing::TestWithParam<std::tuple<const char*, bool, uint32_t, bool>> {};

TEST_P(ReadStored, EveryVoxel) {
    const auto [type, half, packing, offsets] = GetParam();
    AuthoredGrid ball = noisy_ball({3, -5, 4090}, 9);
    ball.type = type, ball.half = half;
    const Read back = read(authored({ball}, packing, offsets));
    EXPECT_EQ(back.report.summary(), "");
    EXPECT_EQ(back.volume.active_low, ivec3(-6, -14, 4081));
    EXPECT_EQ(back.volume.active_high, ivec3(12, 4, 4099));
    for (const auto& [at, value] : ball.voxels)
        ASSERT_NEAR(value_at(back.volume, at), value, half ? value / 2048 : 0) << at.x << ' ' << at.y << ' ' << at.z;
    EXPECT_EQ(value_at(back.volume, {-6, -14, 4081}), 0); // a corner of the box, outside the ball
}

INSTANTIATE_TEST_SUITE_P(All, ReadStored,
                         ::testing::Combine(::testing::Values("float", "double"), ::testing::Bool(),
                                            ::testing::Values(pack_none, pack_mask, pack_zip, pack_zip | pack_mask,
                                                              pack_blosc, pack_blosc | pack_mask),
                                            ::testing::Bool()));

TEST(VdbRead, TransformOfAnyAffineKind) {
    dmat4 sheared(0.5);
    sheared[1][0] = 0.25, sheared[3] = glm::dvec4(-1, 2, 3, 1);
    const dmat4 rotated = glm::rotate(dmat4(1), 0.5, dvec3(0, 1, 0)), moved = glm::translate(dmat4(1), dvec3(4, 5, 6));
    const dmat4 stretched = glm::scale(dmat4(1), dvec3(0.1, 0.2, 0.3)), mirrored = glm::scale(moved, dvec3(-1, 1, 1));
    for (const dmat4& matrix : {dmat4(1), sheared, rotated, moved, stretched, mirrored}) {
        AuthoredGrid grid = small("density");
        grid.index_to_world = matrix;
        const dmat4 back = read(authored({grid})).volume.index_to_world;
        for (int i = 0; i < 16; ++i) EXPECT_NEAR(back[i / 4][i % 4], matrix[i / 4][i % 4], 1e-15);
    }
}

TEST(VdbRead, FrustumIsRefused) {
    AuthoredGrid grid = small("density");
    grid.frustum = true;
    for (const bool offsets : {false, true}) {
        const Error error = refusal(authored({grid}, pack_mask, offsets));
        EXPECT_EQ(error.code, ExitCode::refused);
        EXPECT_THAT(error.what(), HasSubstr("frustum"));
    }
}

// The library abbreviates large uniform regions at three levels of its tree.
TEST(VdbRead, InfoSaysWhatIsTooLarge) {
    const TempFolder scratch;
    AuthoredGrid grid;
    grid.tiles = {{ivec3(0), 3, 1}};
    const VdbGridInfo info = vdb_info(scratch.put("in.vdb", authored({grid}))).grids.at(0);
    EXPECT_FALSE(info.usable);
    EXPECT_FALSE(info.is_fog);
    EXPECT_EQ(info.why_not, "spans 4096x4096x4096 voxels, too many to store: use larger voxels");
}

TEST(VdbRead, TilesOfEveryLevel) {
    AuthoredGrid grid;
    grid.tiles = {{ivec3(0), 1, 0.1f}, {ivec3(128), 2, 0.2f}, {ivec3(4096), 3, 0.3f}};
    const Read back = read(authored({grid}));
    EXPECT_EQ(back.volume.leaves.size(), 0u);
    ASSERT_EQ(back.volume.tiles.size(), 3u);
    EXPECT_EQ(value_at(back.volume, ivec3(7)), 0.1f);
    EXPECT_EQ(value_at(back.volume, ivec3(8)), 0.0f);
    EXPECT_EQ(value_at(back.volume, ivec3(255)), 0.2f);
    EXPECT_EQ(value_at(back.volume, ivec3(8191)), 0.3f);
    EXPECT_EQ(back.volume.active_low, ivec3(0));
    EXPECT_EQ(back.volume.active_high, ivec3(8191));

    const TempFolder scratch;
    const VdbGridInfo info = vdb_info(scratch.put("in.vdb", authored({grid}))).grids.at(0);
    EXPECT_EQ(info.tiles, 3u);
    EXPECT_EQ(info.active_voxels, (1ull << 9) + (1ull << 21) + (1ull << 36));
    EXPECT_FLOAT_EQ(info.maximum, 0.3f);
}

TEST(VdbRead, FarTilesAreRefusedNotDensified) {
    AuthoredGrid grid = small("density");
    grid.tiles = {{ivec3((1 << 24) - 4096), 3, 1.0f}};
    EXPECT_EQ(read(authored({grid})).volume.active_high, ivec3((1 << 24) - 1));
    grid.tiles = {{ivec3(1 << 24), 3, 1.0f}};
    EXPECT_THAT(refusal(authored({grid})).what(), HasSubstr("2^24"));
    grid.tiles = {{ivec3(INT32_MIN), 3, 1.0f}};
    EXPECT_THAT(refusal(authored({grid})).what(), HasSubstr("2^24"));
}

TEST(VdbRead, BackgroundOutsideTheActiveVoxelsIsDropped) {
    AuthoredGrid grid;
    grid.background = 0.5f;
    grid.voxels = {{ivec3(0), 1.0f}, {ivec3(40, 0, 0), 1.0f}, {ivec3(3, 0, 9000), 1.0f}};
    const Read back = read(authored({grid}));
    EXPECT_EQ(back.report.background, 0.5f);
    EXPECT_THAT(back.report.summary(), HasSubstr("background 0.5"));
    EXPECT_EQ(value_at(back.volume, {0, 0, 0}), 1.0f);
    EXPECT_EQ(value_at(back.volume, {1, 0, 0}), 0.5f);  // in a leaf
    EXPECT_EQ(value_at(back.volume, {20, 0, 0}), 0.5f); // between leaves
    for (const int z : {4096, 5000, 8191})              // in a root cell the file does not mention, to its last voxel
        EXPECT_EQ(value_at(back.volume, {40, 0, z}), 0.5f) << z;
    EXPECT_EQ(value_at(back.volume, {40, 0, 9000}), 0.5f);
    EXPECT_EQ(value_at(back.volume, {41, 0, 0}), 0.0f);
    EXPECT_EQ(value_at(back.volume, {0, 1, 0}), 0.0f);
    EXPECT_EQ(value_at(back.volume, {0, 0, 9001}), 0.0f);
}

TEST(VdbRead, InactiveValuesInsideTheBoxStay) {
    AuthoredGrid grid;
    grid.voxels = {{ivec3(0), 1.0f}, {ivec3(0, 0, 4), 1.0f}};
    grid.inactive_voxels = {{ivec3(0, 0, 2), 0.25f}, {ivec3(0, 0, 6), 0.25f}, {ivec3(2, 0, 2), -7.0f}};
    const Read back = read(authored({grid}));
    EXPECT_EQ(value_at(back.volume, {0, 0, 2}), 0.25f);
    EXPECT_EQ(value_at(back.volume, {0, 0, 6}), 0.0f);
    EXPECT_EQ(back.report.summary(), "");
}

// OpenVDB 13 writes 225, as it also knows grids of half floats; all else is as it was.
TEST(VdbRead, NewerFileVersion) {
    const AuthoredGrid ball = noisy_ball(ivec3(0), 12);
    for (const uint32_t packing : {pack_none, pack_mask | pack_zip, pack_mask | pack_blosc}) {
        const std::string old = authored({ball}, packing);
        const SparseVolume was = read(old).volume, is = read(patched(old, 8, 225u)).volume;
        EXPECT_EQ(is.active_high, was.active_high);
        ASSERT_EQ(is.leaves.size(), was.leaves.size());
        for (size_t n = 0; n < is.leaves.size(); ++n) EXPECT_EQ(is.leaves[n].values, was.leaves[n].values);
    }
}

TEST(VdbRead, WrongValuesAreMendedAndCounted) {
    AuthoredGrid grid;
    grid.type = "double"; // holds what float cannot
    grid.voxels = {
        {ivec3(0), 0.5f}, {ivec3(1), std::nanf("")}, {ivec3(2), infinity}, {ivec3(3), -infinity}, {ivec3(4), -1}};
    grid.tiles = {{ivec3(64), 1, -2.0f}, {ivec3(128), 1, std::nanf("")}};
    const Read back = read(authored({grid}));
    EXPECT_EQ(back.report.non_finite, 3u + 512u);
    EXPECT_EQ(back.report.negative, 1u + 512u);
    EXPECT_THAT(back.report.summary(), HasSubstr("513 negative"));
    for (int i = 1; i <= 4; ++i) EXPECT_EQ(value_at(back.volume, ivec3(i)), 0);
    EXPECT_EQ(value_at(back.volume, ivec3(0)), 0.5f);
    EXPECT_TRUE(back.volume.tiles.empty());

    const TempFolder scratch;
    const VdbGridInfo info = vdb_info(scratch.put("in.vdb", authored({grid}))).grids.at(0);
    EXPECT_EQ(info.non_finite, 515u);
    EXPECT_EQ(info.negative, 513u);
    EXPECT_EQ(info.minimum, -2);
    EXPECT_EQ(info.maximum, 0.5f);
}

TEST(VdbRead, NotFiniteBackgroundIsNothing) {
    AuthoredGrid grid;
    grid.background = std::nanf("");
    grid.tiles = {{ivec3(0), 1, 1.0f}};
    const Read back = read(authored({grid}));
    EXPECT_EQ(back.report.background, 0);
    EXPECT_EQ(value_at(back.volume, ivec3(3)), 1.0f);
}

TEST(VdbRead, EmptyGrid) {
    AuthoredGrid grid;
    const Read back = read(authored({grid}));
    EXPECT_TRUE(back.volume.empty());
    EXPECT_EQ(back.report.summary(), "grid \"density\": is empty");
}

TEST(VdbRead, InstancesShareATree) {
    AuthoredGrid first = noisy_ball(ivec3(0), 4), second;
    second.name = "copy", second.instance_of = 0;
    second.index_to_world[3] = glm::dvec4(9, 0, 0, 1);
    const float center = value_at(read(authored({first})).volume, ivec3(0));
    EXPECT_GT(center, 0);
    for (const bool offsets : {false, true}) {
        const Read back = read(authored({first, second}, pack_mask | pack_blosc, offsets), "copy");
        EXPECT_EQ(value_at(back.volume, ivec3(0)), center);
        EXPECT_EQ(back.volume.index_to_world[3].x, 9);
    }
}

// Choosing the grid.

TEST(VdbRead, NameAndIndex) {
    std::vector<AuthoredGrid> grids = {small("density"), small("heat"), small("density"), small("odd[1]")};
    for (size_t i = 0; i < grids.size(); ++i) grids[i].voxels[0].second = static_cast<float>(i + 1);
    const std::string bytes = authored(grids);
    const auto chosen = [&](const std::string& grid) { return value_at(read(bytes, grid).volume, ivec3(1, 2, 3)); };
    EXPECT_EQ(chosen("density"), 1);
    EXPECT_EQ(chosen("density[0]"), 1);
    EXPECT_EQ(chosen("density[1]"), 3);
    EXPECT_EQ(chosen("heat"), 2);
    EXPECT_EQ(chosen("odd[1]"), 4);
    EXPECT_EQ(chosen(""), 1);
    const TempFolder scratch;
    const VdbInfo info = vdb_info(scratch.put("all.vdb", bytes));
    for (size_t i = 0; i < grids.size(); ++i) EXPECT_EQ(chosen(info.grids[i].key), static_cast<float>(i + 1));
    for (const char* wrong : {"smoke", "density[2]", "density[-1]", "density[]", "density[1x]", "heat]"}) {
        const Error error = refusal(bytes, wrong);
        EXPECT_EQ(error.code, ExitCode::refused);
        EXPECT_THAT(error.what(), HasSubstr("density[0] (float), heat (float), density[1] (float), odd[1] (float)"));
    }
}

TEST(VdbRead, WithoutAName) {
    const auto chosen = [&](const std::vector<AuthoredGrid>& grids) { return read(authored(grids)).report.grid; };
    EXPECT_EQ(chosen({small("temperature"), small("Smoke")}), "Smoke");
    EXPECT_EQ(chosen({small("v", "vec3s"), small("mist")}), "mist");
    EXPECT_EQ(chosen({small("distance", "float", "level set"), small("mist")}), "mist");
    EXPECT_EQ(chosen({small("heat"), small("density")}), "density");
    EXPECT_EQ(chosen({small("heat"), small("mist", "float", "fog volume")}), "mist");
    EXPECT_THAT(refusal(authored({small("mist"), small("dust")})).what(), HasSubstr("mist (float), dust (float)"));
    EXPECT_THAT(refusal(authored({small("v", "vec3s"), small("i", "int32")})).what(),
                HasSubstr("v (vec3s), i (int32)"));
}

// Heat is never lit as fog because the density beside it cannot be.
TEST(VdbRead, AnotherQuantityIsTakenByNameOnly) {
    for (const AuthoredGrid& density : {small("density", "float", "level set"), small("density", "vec3s")}) {
        const std::string bytes = authored({density, small("temperature")});
        EXPECT_THAT(refusal(bytes).what(), HasSubstr("grid \"density\": "));
        EXPECT_THAT(refusal(bytes).what(), HasSubstr("temperature (float)"));
        EXPECT_EQ(read(bytes, "temperature").report.grid, "temperature");
    }
    for (const char* name : {"temperature", "Heat", "flames", "vel.x"})
        EXPECT_THAT(refusal(authored({small(name)})).what(),
                    HasSubstr("is not named as a density; to use it as fog, set \"grid\" to its name"));
}

TEST(VdbRead, WhatIsNoDensityIsRefused) {
    for (const bool offsets : {false, true}) {
        const Error error = refusal(authored({small("distance", "float", "level set")}, pack_mask, offsets));
        EXPECT_EQ(error.code, ExitCode::refused);
        EXPECT_THAT(error.what(), HasSubstr("ls2fog"));
        for (const char* type : {"vec3s", "vec3d", "vec3i", "int32", "int64", "bool", "mask"}) {
            const Error wrong = refusal(authored({small("g", type)}, pack_mask | pack_blosc, offsets), "g");
            EXPECT_EQ(wrong.code, ExitCode::refused);
            EXPECT_THAT(wrong.what(), HasSubstr(std::string("grid \"g\": holds ") + type));
        }
    }
}

// Grids before the wanted one are passed by, whatever they hold and whether or not the file has offsets.
TEST(VdbRead, OtherGridsAreNotInTheWay) {
    std::vector<AuthoredGrid> grids;
    for (const char* type : {"vec3s", "vec3d", "vec3i", "int32", "int64", "bool", "mask", "double"}) {
        grids.push_back(noisy_ball(ivec3(2), 10));
        grids.back().name = type, grids.back().type = type;
        grids.push_back(grids.back());
        grids.back().name += "_half", grids.back().half = true;
    }
    grids.push_back(noisy_ball(ivec3(2), 3));
    for (const bool offsets : {false, true})
        for (const uint32_t packing : {pack_none, pack_mask | pack_zip, pack_mask | pack_blosc}) {
            const std::string bytes = authored(grids, packing, offsets);
            EXPECT_EQ(read(bytes).volume.active_high, ivec3(5));
            const TempFolder scratch;
            for (const VdbGridInfo& info : vdb_info(scratch.put("in.vdb", bytes)).grids)
                EXPECT_EQ(info.active_voxels,
                          info.name == "density" ? grids.back().voxels.size() : grids[0].voxels.size());
        }
}

TEST(VdbInfo, TellsWhatIsThere) {
    AuthoredGrid grid = noisy_ball(ivec3(0), 5);
    grid.index_to_world = glm::scale(dmat4(1), dvec3(0.1, 0.2, 0.3));
    const TempFolder scratch;
    const VdbInfo info = vdb_info(scratch.put("in.vdb", authored({grid, small("v", "vec3s")})));
    EXPECT_EQ(info.file_version, 224u);
    EXPECT_EQ(info.library_version, "10.0");
    EXPECT_EQ(info.metadata.at(0), std::make_pair(std::string("origin"), std::string("authored")));
    ASSERT_EQ(info.grids.size(), 2u);
    double sum = 0;
    for (const auto& voxel : grid.voxels) sum += static_cast<double>(voxel.second);
    EXPECT_TRUE(info.grids[0].usable);
    EXPECT_EQ(info.grids[0].active_voxels, grid.voxels.size());
    EXPECT_EQ(info.grids[0].leaves, 8u);
    EXPECT_NEAR(info.grids[0].mean, sum / static_cast<double>(grid.voxels.size()), 1e-6);
    EXPECT_EQ(info.grids[0].voxel_size, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(info.grids[0].active_low, ivec3(-5));
    EXPECT_FALSE(info.grids[1].usable);
    EXPECT_THAT(info.grids[1].why_not, HasSubstr("vec3s"));
}

// Replaced by a rename or cut in place while it is read: the old fog, the new one or an Error.
TEST(VdbRead, FileThatChangesUnderneath) {
    const TempFolder scratch;
    AuthoredGrid ball = noisy_ball(ivec3(0), 12);
    const std::string old = authored({ball});
    ball.voxels[0].second = 2;
    const std::string fresh = authored({ball});
    const ivec3 at = ball.voxels[0].first;
    const auto file = scratch.put("a.vdb", old);
    std::atomic<bool> done = false;
    std::thread other([&] {
        for (int i = 0; !done; ++i) {
            if (i % 3 == 0)
                std::filesystem::resize_file(file, old.size() / 2);
            else
                std::filesystem::rename(scratch.put("b.vdb", i % 3 == 1 ? old : fresh), file);
        }
    });
    const float before = noisy_ball(ivec3(0), 12).voxels[0].second;
    for (int i = 0; i < 100; ++i) {
        float value = 0;
        const Error error = error_of([&] { value = value_at(read_vdb(file), at); });
        if (error.code == ExitCode::ok)
            EXPECT_TRUE(value == before || value == 2) << value;
        else
            EXPECT_EQ(error.code, ExitCode::refused) << error.what();
    }
    done = true;
    other.join();
}

TEST(VdbRead, MoreThanTheMemoryThereIs) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer takes more address space than there is memory";
#endif
    const TempFolder scratch;
    SparseVolume volume;
    volume.leaves.resize(40000); // 90 MB
    for (int i = 0; i < 40000; ++i) {
        volume.leaves[static_cast<size_t>(i)].origin = ivec3(i % 200, i / 200, 0) * 8;
        volume.leaves[static_cast<size_t>(i)].values.fill(0.5f);
    }
    write_vdb(scratch.path() / "a.vdb", volume);
    volume = {};
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    rlimit small = before;
    small.rlim_cur = 64 << 20;
    ASSERT_EQ(setrlimit(RLIMIT_AS, &small), 0);
    const Error error = error_of([&] { read_vdb(scratch.path() / "a.vdb"); });
    setrlimit(RLIMIT_AS, &before);
    EXPECT_EQ(error.code, ExitCode::out_of_memory) << error.what();
    EXPECT_EQ(error_of([&] { read_vdb(scratch.path() / "a.vdb"); }).code, ExitCode::ok);
}

TEST(VdbRead, WhatIsNoVolume) {
    const TempFolder scratch;
    EXPECT_EQ(error_of([&] { read_vdb(scratch.path() / "missing.vdb"); }).code, ExitCode::unreadable);
    EXPECT_EQ(error_of([&] { read_vdb(scratch.path()); }).code, ExitCode::unreadable);
    EXPECT_EQ(error_of([&] { read_vdb("/dev/zero"); }).code, ExitCode::unreadable);
    EXPECT_THAT(refusal("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n").what(),
                HasSubstr("git lfs pull"));
    EXPECT_THAT(refusal("").what(), HasSubstr("is neither an OpenVDB"));
    EXPECT_THAT(refusal(std::string("\x20\x42\x44\x56\0\0\0\0", 8)).what(), HasSubstr("is truncated"));
}
}
}

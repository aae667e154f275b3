// NanoVDB files hold the same fog as the OpenVDB files they were made from, or are refused by name.
#include "support/corpus.h"
#include "volume/vdb/nano/fixtures.h"
#include "volume/vdb/vdb.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

namespace tyndall {
namespace {
using namespace testing;
using ::testing::HasSubstr;

SparseVolume read(const std::string& bytes, const std::string& grid = "") {
    const TempFolder scratch;
    return read_vdb(scratch.put("in.nvdb", bytes), grid);
}

Error refusal(const std::string& bytes) {
    return error_of([&] { read(bytes); });
}

// Leaves, tiles of all levels, values that are not active, a background and a transform that turns.
AuthoredGrid all_kinds() {
    AuthoredGrid grid = noisy_ball({3, -5, 4090}, 9);
    grid.grid_class = "fog volume", grid.background = 0.25f;
    grid.index_to_world =
        glm::rotate(glm::translate(dmat4(1), dvec3(1, 2, 3)), 0.7, dvec3(1, 2, 0.5)) * glm::scale(dmat4(1), dvec3(0.1));
    grid.tiles = {
        {ivec3(64), 1, 0.5f}, {ivec3(256), 2, 0.75f}, {ivec3(-8192), 3, 0.5f}, {ivec3(128, 0, 0), 1, 0.4f, false}};
    grid.inactive_voxels = {{ivec3(3, -5, 4110), 0.3f}};
    return grid;
}

std::vector<std::tuple<int, int, int, float>> contents(const SparseVolume& volume) {
    std::vector<std::tuple<int, int, int, float>> list;
    for (const Leaf& leaf : volume.leaves)
        for (int v = 0; v < 512; ++v)
            list.emplace_back(leaf.origin.x + (v >> 6), leaf.origin.y + (v >> 3 & 7), leaf.origin.z + (v & 7),
                              leaf.values[static_cast<size_t>(v)]);
    for (const Tile& tile : volume.tiles) {
        list.emplace_back(tile.low.x, tile.low.y, tile.low.z, tile.value);
        list.emplace_back(tile.high.x, tile.high.y, tile.high.z, tile.value);
    }
    std::ranges::sort(list);
    return list;
}

void expect_same(const SparseVolume& nano, const SparseVolume& open) {
    EXPECT_EQ(nano.name, open.name);
    EXPECT_EQ(nano.active_low, open.active_low);
    EXPECT_EQ(nano.active_high, open.active_high);
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(nano.index_to_world[i / 4][i % 4], open.index_to_world[i / 4][i % 4], 1e-12);
    EXPECT_EQ(contents(nano), contents(open));
}

TEST(Nano, SameFogAsOpenVdb) {
    for (const char* type : {"float", "double"})
        for (const NanoPacking packing : {NanoPacking::none, NanoPacking::zip, NanoPacking::blosc}) {
            AuthoredGrid grid = all_kinds();
            grid.type = type;
            expect_same(read(nano_authored({grid}, packing)), read(authored({grid})));
        }
}

// A leaf's values lie on as many steps between its least and its greatest as its bits allow.
TEST(Nano, QuantizedFloats) {
    const AuthoredGrid ball = noisy_ball({3, -5, 4090}, 9);
    for (const auto& [store, steps] :
         {std::pair(NanoStore::fp4, 15), {NanoStore::fp8, 255}, {NanoStore::fp16, 65535}}) {
        const SparseVolume volume = read(nano_authored({ball}, NanoPacking::blosc, store));
        for (const auto& [at, value] : ball.voxels) // dithered: up to a step off
            ASSERT_NEAR(value_at(volume, at), value, 0.61 / steps);
    }
    const SparseVolume variable = read(nano_authored({ball}, NanoPacking::none, NanoStore::fpn));
    for (const auto& [at, value] : ball.voxels) ASSERT_NEAR(value_at(variable, at), value, 0.1);
}

TEST(Nano, SeveralGridsAndVectors) {
    AuthoredGrid density = noisy_ball(ivec3(0), 6), color = noisy_ball(ivec3(0), 6), flags;
    density.grid_class = "fog volume";
    color.name = "Cd", color.type = "vec3s", color.voxels = {},
    color.colors = {{ivec3(1, 2, 3), vec3(0.1f, 0.2f, 0.3f)}};
    flags.name = "flags", flags.type = "int32", flags.voxels = {{ivec3(1), 2.0f}};
    const TempFolder scratch;
    const auto file = scratch.put("in.nvdb", nano_authored({density, color, flags}, NanoPacking::zip));
    const VdbInfo info = vdb_info(file);
    ASSERT_EQ(info.grids.size(), 3u); // by name
    EXPECT_EQ(info.format, "NanoVDB");
    EXPECT_EQ(info.compression, "zip");
    EXPECT_EQ(info.grids[1].active_voxels, density.voxels.size());
    EXPECT_EQ(info.grids[1].active_high, ivec3(6));
    EXPECT_TRUE(info.grids[1].is_fog);
    EXPECT_THAT(info.grids[2].why_not, HasSubstr("int32"));
    const std::string name = "Cd";
    const ColorVolume read = read_color_vdb(file, {&name, 1}, {}, infinity, nullptr);
    ASSERT_EQ(read.channels.size(), 3u);
    for (int c = 0; c < 3; ++c)
        EXPECT_EQ(value_at(read.channels[static_cast<size_t>(c)], ivec3(1, 2, 3)), vec3(0.1f, 0.2f, 0.3f)[c]);
    EXPECT_EQ(value_at(read.coverage, ivec3(1, 2, 3)), 1);
}

TEST(Nano, LevelSetsNeedAWidth) {
    AuthoredGrid ball = noisy_ball(ivec3(0), 6);
    ball.grid_class = "level set", ball.background = 0.3f;
    EXPECT_THAT(refusal(nano_authored({ball})).what(), HasSubstr("width"));
}

TEST(Nano, DamageIsRefusedByName) {
    const std::string whole = nano_authored({noisy_ball(ivec3(0), 6)});
    const size_t grid = whole.size() - 672; // not more than a file's head is before it
    EXPECT_THAT(refusal(whole.substr(0, 100)).what(), HasSubstr("is truncated"));
    EXPECT_THAT(refusal(whole.substr(0, whole.size() - 1)).what(), HasSubstr("is truncated"));
    EXPECT_THAT(refusal(patched(whole, 8, uint32_t{31u << 21 | 5u << 10})).what(), HasSubstr("NanoVDB 31.5"));
    EXPECT_THAT(refusal(patched(whole, 14, uint16_t{7})).what(), HasSubstr("compression is unknown: 7"));
    EXPECT_THAT(refusal(patched(whole, 16, uint64_t{1} << 40)).what(), HasSubstr("claims"));
    EXPECT_THAT(refusal("NanoVDB0 and so on, for a while").what(), HasSubstr("is NanoVDB"));
    EXPECT_GT(grid, 0u);

    // Where the tree says that its root is.
    const size_t tree = whole.find("density", 200) - 40 + 672;
    EXPECT_THAT(refusal(patched(whole, tree + 24, uint64_t{1} << 40)).what(), HasSubstr("points outside"));
    EXPECT_THAT(refusal(patched(whole, tree + 24, uint64_t{3})).what(), HasSubstr("points outside"));
}

TEST(Nano, ByOthers) {
    for (const auto& file : test::corpus_files_named({"vdb/nanovdb/teapot_cloud-RENDER-0.85.nvdb"})) {
        const SparseVolume volume = read_vdb(file);
        EXPECT_EQ(volume.active_low, ivec3(-136, -60, -90));
        EXPECT_EQ(volume.active_high, ivec3(130, 73, 87));
        EXPECT_EQ(vdb_info(file).grids[0].active_voxels, 1963736u);
    }
}
}
}

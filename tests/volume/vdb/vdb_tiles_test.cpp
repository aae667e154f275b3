// Inactive tiles, of which a few bytes of a file expand to thousands: those outside the fog are left out, and rows of
// equal ones stored as one.
#include "volume/vdb/load.h"
#include "volume/vdb/memory.h"
#include "volume/vdb/nano/fixtures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace testing;
using ::testing::HasSubstr;

// A level set of two voxels, 2000 apart.
AuthoredGrid sparse_level_set() {
    AuthoredGrid grid;
    grid.grid_class = "level set", grid.background = 3;
    grid.voxels = {{ivec3(0), -1.0f}, {ivec3(0, 0, 2000), -1.0f}};
    grid.tiles = {{ivec3(0, 0, 1024), 2, -3.0f, false}, {ivec3(0, 4096, 0), 3, -3.0f, false}};
    return grid;
}

TEST(VdbTiles, InactiveOnesOutsideTheBoxOfTheActiveVoxelsAreLeftOut) {
    const TempFolder scratch;
    const auto open_vdb = scratch.put("in.vdb", authored({sparse_level_set()}));
    const auto nano = scratch.put("in.nvdb", nano_authored({sparse_level_set()}));
    for (const auto& path : {open_vdb, nano}) {
        ByteCursor file(path);
        const VdbDirectory directory = read_directory(file);
        VdbTreeCounts counts;
        const DecodedTree tree = load_tree(file, directory, directory.grids[0], counts);
        EXPECT_EQ(tree.inactive_tiles.size(), 5u) << "rows of 15, 7, 1, 6 and 10 tiles, of 40956";
        EXPECT_EQ(counts.inactive_tiles, tree.inactive_tiles.size());
        VdbTreeCounts without = counts;
        without.inactive_tiles = 0;
        EXPECT_EQ(memory_needed(counts), memory_needed(without) + counts.inactive_tiles * sizeof(Tile));
    }
}

TEST(VdbTiles, TheInsideOfALevelSetIsFog) {
    const TempFolder scratch;
    ValueMap map;
    map.width = 2;
    for (const std::string& bytes : {authored({sparse_level_set()}), nano_authored({sparse_level_set()})}) {
        const SparseVolume fog = read_vdb(scratch.put("in.vdb", bytes), "", map, infinity, nullptr);
        for (const int z : {0, 2000}) EXPECT_EQ(value_at(fog, {0, 0, z}), 0.5f);
        for (const int z : {1024, 1151}) EXPECT_EQ(value_at(fog, {0, 0, z}), 1);
        for (const int z : {1, 8, 1023, 1152, 1999}) EXPECT_EQ(value_at(fog, {0, 0, z}), 0);
    }
}

TEST(VdbTiles, TooManyAreRefused) {
    VdbTreeCounts counts;
    counts.active_tiles = uint64_t{1} << 25, counts.inactive_tiles = (uint64_t{1} << 25) + 1;
    EXPECT_THAT(error_message(ExitCode::refused, [&] { check_tree(counts, 0, "x.vdb"); }),
                HasSubstr("x.vdb: has 67108865 tiles inside the bounding box of its active voxels; at most 67108864"));
}
}
}

// What many threads encode and decode, against the library's own writer, which takes one leaf after the other.
#include "base/parallel.h"
#include "support/threads.h"
#include "volume/bricks/voxel_mask.h"
#include "volume/vdb/file/prewalk.h"
#include "volume/vdb/vdb.h"
#include "volume/vdb/vdb_fixtures.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace tyndall::testing {
namespace {
// More leaves than are encoded at once, in no order and in several root nodes: full, with gaps, of one voxel, empty.
// Values are multiples of a step; those of 1/1024 are exact in half.
SparseVolume many_leaves(float step) {
    SparseVolume volume;
    std::mt19937 random(11);
    for (int i = 0; i < 900; ++i) {
        Leaf leaf;
        leaf.origin = 8 * ivec3((i * 37) % 30 - 15, i / 30 * 20 - 300, (i * 11) % 17 + 500 * (i % 3));
        const uint32_t share = static_cast<uint32_t>(i) % 5; // of 4 voxels
        for (float& value : leaf.values)
            if (random() % 4 < share) value = static_cast<float>(random() % 2047 + 1) * step;
        if (i % 50 == 0) leaf.values = {}, leaf.values[static_cast<size_t>(i) % 512] = 0.5f;
        volume.leaves.push_back(leaf);
    }
    volume.tiles.push_back({ivec3(1024), ivec3(1151), 0.75f});
    volume.tiles.push_back({ivec3(2003), ivec3(2009, 2010, 2011), 0.25f}); // in parts of eight leaves
    return volume;
}

AuthoredGrid same_for_library(const SparseVolume& volume, bool half) {
    AuthoredGrid grid;
    grid.half = half;
    for (const Leaf& leaf : volume.leaves)
        for (int v = 0; v < 512; ++v)
            if (const float value = leaf.values[static_cast<size_t>(v)]; value > 0)
                grid.voxels.emplace_back(leaf.origin + ivec3(v >> 6, v >> 3 & 7, v & 7), value);
    grid.tiles.push_back({ivec3(1024), 2, 0.75f, true});
    for (int x = 2003; x <= 2009; ++x)
        for (int y = 2003; y <= 2010; ++y)
            for (int z = 2003; z <= 2011; ++z) grid.voxels.emplace_back(ivec3(x, y, z), 0.25f);
    return grid;
}

// The bytes of the only tree, and what its grid says of it.
std::pair<std::string, std::map<std::string, std::string>> tree_of(const std::filesystem::path& path) {
    ByteCursor file(path);
    const VdbDirectory directory = read_directory(file);
    EXPECT_EQ(directory.grids.size(), 1u);
    const VdbGridEntry& grid = directory.grids.at(0);
    EXPECT_EQ(grid.tree_end, std::filesystem::file_size(path));
    std::map<std::string, std::string> statistics;
    for (const auto& [key, text] : grid.metadata)
        if (key.starts_with("file_") && key != "file_compression") statistics[key] = text;
    file.seek(grid.tree_begin, "the tree");
    return {file.bytes(grid.tree_end - grid.tree_begin, "the tree"), statistics};
}

TEST(VdbLibrary, WritesTheSameBytes) {
    const TempFolder scratch;
    SparseVolume volume = many_leaves(0.0007f);
    for (Leaf& leaf : volume.leaves)
        if (leaf.values[7] > 0) leaf.values[7] = 3.3e-7f; // a subnormal half
    for (const bool half : {true, false})
        for (const bool blosc : {true, false}) {
            const auto path = scratch.put(
                "library.vdb", authored({same_for_library(volume, half)}, pack_mask | (blosc ? pack_blosc : pack_zip)));
            const auto [expected, statistics] = tree_of(path);
            ASSERT_GE(statistics.size(), 4u); // box, voxels, memory
            for (const int threads : {1, 2, 5}) {
                const Threads limit(threads);
                write_vdb(scratch.path() / "ours.vdb", volume, {.half = half, .blosc = blosc});
                const auto [bytes, said] = tree_of(scratch.path() / "ours.vdb");
                EXPECT_TRUE(bytes == expected) << half << blosc << threads;
                EXPECT_EQ(said, statistics);
            }
        }
}

// The bytes of every tree of a file.
std::vector<std::string> trees_of(const std::filesystem::path& path) {
    ByteCursor file(path);
    std::vector<std::string> trees;
    for (const VdbGridEntry& grid : read_directory(file).grids) {
        file.seek(grid.tree_begin, "the tree");
        trees.push_back(file.bytes(grid.tree_end - grid.tree_begin, "the tree"));
    }
    return trees;
}

TEST(VdbLibrary, WritesTheSameVectors) {
    // Numbers, and vectors of both signs on their voxels, some of them nought.
    const TempFolder scratch;
    const SparseVolume volume = many_leaves(0x1p-10f);
    const auto vector_of = [](float value) { return vec3(value - 0.75f, value < 1 ? 0 : -2 * value, 0.5f * value); };
    VdbContent content{{{"density"}, {"vel", true}}, dmat4(1), {}, {}, {}, {}};
    for (const Leaf& leaf : volume.leaves) content.origins.push_back(leaf.origin);
    content.fill = [&](size_t number, std::span<Leaf> leaves) {
        leaves[0] = volume.leaves[number];
        for (size_t v = 0; v < 512; ++v)
            for (int axis = 0; axis < 3; ++axis)
                leaves[1 + static_cast<size_t>(axis)].values[v] = vector_of(leaves[0].values[v])[axis];
    };
    for (const bool half : {true, false})
        for (const bool blosc : {true, false}) {
            AuthoredGrid density, velocity;
            velocity.name = "vel", velocity.type = "vec3s", density.half = velocity.half = half;
            for (const Leaf& leaf : volume.leaves)
                for (int v = 0; v < 512; ++v)
                    if (const float value = leaf.values[static_cast<size_t>(v)]; value > 0) {
                        const ivec3 at = leaf.origin + ivec3(v >> 6, v >> 3 & 7, v & 7);
                        density.voxels.emplace_back(at, value), velocity.colors.emplace_back(at, vector_of(value));
                    }
            const auto path =
                scratch.put("library.vdb", authored({density, velocity}, pack_mask | (blosc ? pack_blosc : pack_zip)));
            const auto ours = scratch.path() / "ours.vdb";
            for (const int threads : {1, 3}) {
                const Threads limit(threads);
                VdbImage(content, {.half = half, .blosc = blosc}, "ours").write(ours);
                EXPECT_TRUE(trees_of(ours) == trees_of(path)) << half << blosc << threads;
            }
            EXPECT_TRUE(is_as_written(ours));
        }
}

TEST(VdbLibrary, ReadsWhatTheLibraryWrote) {
    const TempFolder scratch;
    for (const std::string type : {"float", "double"})
        for (const uint32_t packing : {pack_none, pack_mask, pack_zip, pack_mask | pack_blosc}) {
            AuthoredGrid grid = same_for_library(many_leaves(0x1p-10f), packing == pack_mask);
            grid.type = type;
            const auto path = scratch.put("library.vdb", authored({grid}, packing));
            std::map<std::array<int, 3>, float> expected;
            for (const auto& [at, value] : grid.voxels) expected[{at.x, at.y, at.z}] = value;
            for (const int threads : {1, 2}) {
                const Threads limit(threads);
                const SparseVolume volume = read_vdb(path);
                size_t found = 0;
                for (const Leaf& leaf : volume.leaves)
                    for (int v = 0; v < 512; ++v) {
                        const float value = leaf.values[static_cast<size_t>(v)];
                        if (value == 0) continue;
                        const ivec3 at = leaf.origin + ivec3(v >> 6, v >> 3 & 7, v & 7);
                        ASSERT_EQ(value, expected.at({at.x, at.y, at.z}));
                        ++found;
                    }
                EXPECT_EQ(found, expected.size());
                ASSERT_EQ(volume.tiles.size(), 1u);
            }
        }
}

TEST(VdbLibrary, LeavesThatShareAnOriginAreAnError) {
    const TempFolder scratch;
    SparseVolume volume;
    volume.leaves.resize(2);
    for (Leaf& leaf : volume.leaves) leaf.values[3] = 1;
    EXPECT_EQ(error_of([&] { write_vdb(scratch.path() / "a.vdb", volume); }).code, ExitCode::internal);
    EXPECT_TRUE(scratch.names().empty());
}

TEST(VoxelMasks, HoldWhatIsAboveTheThreshold) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        std::array<float, 512> values{};
        ivec3 low(8), high(-1);
        VoxelMask expected{};
        size_t count = 0;
        for (int i = 0; i <= round % 9; ++i) {
            const uint32_t v = random() % 512;
            const float candidates[] = {0.25f, 0.5f, 1, infinity, -1, std::nanf("")};
            values[v] = candidates[random() % 6];
        }
        for (int v = 0; v < 512; ++v) {
            if (!(values[static_cast<size_t>(v)] > 0.25f)) continue;
            const ivec3 at(v >> 6, v >> 3 & 7, v & 7);
            low = glm::min(low, at), high = glm::max(high, at);
            expected[static_cast<size_t>(v / 64)] |= uint64_t{1} << (v % 64);
            ++count;
        }
        const VoxelMask mask = voxels_above(values, 0.25f);
        ASSERT_EQ(mask, expected);
        ASSERT_EQ(count_voxels(mask), count);
        if (count == 0) continue;
        ivec3 found_low, found_high;
        bounds_of(mask, found_low, found_high);
        ASSERT_EQ(found_low, low);
        ASSERT_EQ(found_high, high);
    }
}
}
}

// How a frame's samples are cut into parts.
#include "render/frame/part.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::test {
namespace {
// How often each slice of a leaf is in the parts: its number is leaf × slices + slice.
std::map<int64_t, int> slices_in(int parts, int first_group, int groups, int leaves, int64_t blocks) {
    std::map<int64_t, int> times;
    for (int part = 1; part <= parts; ++part) {
        const PartRange range = part_range(part, parts, first_group, groups, leaves, blocks);
        EXPECT_LT(range.first, range.last) << "part " << part << " of " << parts << " has nothing to do";
        for (int64_t slice = range.first; slice < range.last; ++slice) ++times[slice];
    }
    return times;
}

TEST(Parts, HoldEverySliceExactlyOnce) {
    for (const int parts : {1, 2, 3, 5, 7, 8, 15, 16, 17, 63, 64, 65, 200})
        for (const int leaves : {1, 4, 8}) {
            const std::map<int64_t, int> times = slices_in(parts, 2, 8, leaves, 100);
            const int slices = (parts + 8 * leaves - 1) / (8 * leaves);
            ASSERT_EQ(times.size(), static_cast<size_t>(8 * leaves * slices));
            EXPECT_EQ(times.begin()->first, int64_t{2} * leaves * slices);
            for (const auto& [slice, count] : times) EXPECT_EQ(count, 1) << slice;
        }
}

TEST(Parts, AreNoMoreThanThereAreLeavesOfBlocks) {
    EXPECT_NO_THROW(part_range(48, 48, 0, 2, 4, 6));
    EXPECT_THROW(part_range(1, 49, 0, 2, 4, 6), Error);
}

TEST(Parts, NodesAreTheLargestThatLieInThem) {
    // Leaves 3 to 20 of groups of eight.
    const std::vector<SumNode> nodes = nodes_of({3, 21, 1}, 8);
    const std::vector<SumNode> expected{{0, 0, 3}, {0, 2, 1}, {1, 3, 0}, {2, 2, 0}, {2, 0, 4}};
    EXPECT_EQ(nodes, expected);
}

TEST(Parts, NodesHoldTheLeavesOfThePartInOrder) {
    for (int64_t first = 0; first < 24; ++first)
        for (int64_t last = first + 1; last <= 24; ++last) {
            int64_t next = first;
            for (const SumNode& node : nodes_of({first, last, 1}, 8)) {
                EXPECT_EQ(int64_t{8} * node.section + (int64_t{node.index} << node.level), next);
                EXPECT_LE(node.level, 3);
                next += int64_t{1} << node.level;
            }
            EXPECT_EQ(next, last);
        }
}

TEST(Parts, SlicesOfLeavesAreNodesByThemselves) {
    // Slices 2 of leaf 0 to 1 of leaf 2, of three.
    const std::vector<SumNode> nodes = nodes_of({2, 8, 3}, 2);
    const std::vector<SumNode> expected{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    EXPECT_EQ(nodes, expected);
}
}
}

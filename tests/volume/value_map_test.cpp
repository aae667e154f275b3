#include "volume/value_map.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
TEST(ValueMap, ScalesThenLimitsThenLooksUp) {
    ValueMap map;
    EXPECT_TRUE(map.changes_nothing());
    EXPECT_EQ(map(-3), -3);
    map.scale = 2, map.offset = 1;
    EXPECT_EQ(map(3), 7);
    map.clamp = {0, 5};
    EXPECT_EQ(map(3), 5);
    EXPECT_EQ(map(-3), 0);
    map.table = {{1, 10}, {3, 20}, {4, 0}};
    EXPECT_EQ(map(0), 10);
    EXPECT_EQ(map(0.5f), 15);
    EXPECT_EQ(map(1.25f), 10);
    EXPECT_EQ(map(9), 0);
    EXPECT_EQ(map(-9), 10);
    EXPECT_TRUE(std::isnan(map(std::nanf(""))));
}

TEST(ValueMap, LevelSetsBecomeFogInsideTheirSurface) {
    ValueMap map;
    map.width = 0.5f;
    EXPECT_EQ(map(1), 0);
    EXPECT_EQ(map(0), 0);
    EXPECT_EQ(map(-0.25f), 0.5f);
    EXPECT_EQ(map(-3), 1);
}

TEST(ValueMap, TextTellsMapsApart) {
    ValueMap a, b;
    EXPECT_EQ(a.text(), "");
    a.scale = 2;
    EXPECT_NE(a.text(), b.text());
    b.offset = 2;
    EXPECT_NE(a.text(), b.text());
}
}
}

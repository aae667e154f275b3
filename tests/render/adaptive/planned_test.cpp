// What a plan says of the error of its frames.
#include "render/adaptive/planned.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
FrameStats with_noise(double bound) {
    FrameStats stats;
    stats.noise = Noise{0.8 * bound, bound, bound};
    return stats;
}

TEST(Planned, GroupsThatLackFollowFromNoise) {
    PlannedError planned;
    planned.target = 0.03;
    EXPECT_EQ(groups_lacking(planned, with_noise(0.03), 8), 0);
    EXPECT_EQ(groups_lacking(planned, with_noise(0.06), 8), std::ceil(1.05 * 8 * 4) - 8);
    EXPECT_EQ(groups_lacking({}, with_noise(1), 8), 0) << "no target was asked for";
}

TEST(Planned, WhatSamplesDoNotRemoveIsLeftOutOfThem) {
    PlannedError planned;
    planned.target = 0.05;
    FrameStats stats = with_noise(0.05);
    stats.integrator = Integrator{{0.02, 0.03}, "draft", {}}; // 0.04 are left
    EXPECT_EQ(groups_lacking(planned, stats, 8), std::ceil(1.05 * 8 * 25 / 16.0) - 8);
    stats.integrator->error.bound = 0.05;
    EXPECT_EQ(groups_lacking(planned, stats, 8), infinity);
}
}
}

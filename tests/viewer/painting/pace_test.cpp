#include "viewer/painting/pace.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// Runs pictures whose cost is so many seconds fixed and so many at full size; returns the levels.
std::vector<int> run(double fixed, double whole, int pictures, double wanted = 1.0 / 30) {
    Pace pace;
    pace.wanted = wanted;
    std::vector<int> levels;
    for (int i = 0; i < pictures; ++i) {
        levels.push_back(pace.level);
        update_pace(pace, fixed + whole * pace.scale() * pace.scale(), fixed);
    }
    return levels;
}
}

TEST(Pace, CheapPicturesBecomeWhole) { EXPECT_EQ(run(0.002, 0.02, 10).back(), 0); }

TEST(Pace, DearOnesStayInTime) {
    for (const double whole : {0.1, 0.3, 1.0}) {
        const int level = run(0.001, whole, 200)[100];
        const double scale = pace_scales[static_cast<size_t>(level)];
        EXPECT_LT(0.001 + whole * scale * scale, 1.15 / 30) << whole;
        const double larger = pace_scales[static_cast<size_t>(level - 1)];
        EXPECT_GT(0.001 + whole * larger * larger, 0.85 / 30) << whole << ": a larger one would have fit";
    }
}

TEST(Pace, FixedCostAloneDoesNotShrinkThePicture) { EXPECT_EQ(run(0.2, 0.005, 30).back(), 0); }

TEST(Pace, ALevelThatWasTooSlowIsNotTriedAtOnceAgain) {
    Pace pace;
    pace.level = 2;
    update_pace(pace, 0.05, 0.001); // too slow
    const int level = pace.level;
    EXPECT_GT(level, 2);
    for (int i = 0; i < 59; ++i) {
        update_pace(pace, 0.002, 0.001);
        EXPECT_GT(pace.level, 2) << i;
    }
    for (int i = 0; i < 5; ++i) update_pace(pace, 0.002, 0.001);
    EXPECT_LT(pace.level, 2);
}
}

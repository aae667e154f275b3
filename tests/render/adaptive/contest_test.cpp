// Modes against each other: what measuring them may cost, and what they may cost where they fail.
#include "render/adaptive/contest.h"

#include "modes/mode.h"
#include "modes/settings.h"
#include "render/adaptive/to_target.h"
#include "render/frame/noise_fixtures.h"
#include "scene/light.h"
#include "support/tiny_scenes.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall::test {
namespace {
const FrameOptions plain{};

struct LitBox {
    View view;
    Snapshot snapshot =
        snapshot_of(std::vector{homogeneous_medium(0.1f, Box{vec3(-4), vec3(4)})}, {sun_light({0, -1, -0.2f})});
    Settings settings = settings_for(Quality::preview);

    LitBox() {
        view.camera = look_at({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 0.9f);
        view.size = {64, 36}, view.pixel_samples = 1;
    }
};

LitBox lamp_in_box() {
    LitBox box;
    box.snapshot =
        snapshot_of(std::vector{homogeneous_medium(0.1f, Box{vec3(-4), vec3(4)})}, {point_light(vec3(0, 0.5f, 0), 20)});
    return box;
}

// A second passes each time it is looked at.
struct StepClock {
    std::shared_ptr<double> seconds = std::make_shared<double>(0);
    double operator()() const { return *seconds += 1; }
};
}

TEST(Contest, AModeThatMayMissTheTargetHasToBeThatMuchQuicker) {
    const Goal goal{0.05};
    Contender main, other;
    main.samples = other.samples = 1;
    main.seconds = 2, other.seconds = 1;
    EXPECT_TRUE(beats(other, main, goal));
    other.risk = 0.9;
    EXPECT_TRUE(beats(other, main, goal));
    other.risk = 1.1;
    EXPECT_FALSE(beats(other, main, goal));
    EXPECT_TRUE(beats(main, other, goal));
    main.seconds = 4, main.done = 3; // an image begun already has less to go
    EXPECT_TRUE(beats(main, other, goal));
    main.done = 1;
    EXPECT_TRUE(beats(other, main, goal));
}

TEST(Contest, OnlyModesThatLeaveLittleRoomForNoiseAreARisk) {
    const LitBox box;
    Goal goal{0, 0, Quality::preview, steady_seconds};
    int risky = 0, safe = 0;
    for (const double error : {0.003, 0.01, 0.03, 0.1}) {
        goal.error = error;
        const Contest contest = hold_contest(modes(), box.view, box.snapshot, box.settings, goal, infinity, plain);
        for (const Contender& contender : contest.contenders) {
            if (contender.mode == &main_mode()) continue;
            EXPECT_EQ(contender.risk > 0, !leaves_room(contender.choice, error)) << contender.mode->name;
            ++(contender.risk > 0 ? risky : safe);
        }
    }
    EXPECT_GT(risky, 0);
    EXPECT_GT(safe, 0);
}

// Measuring the others takes a twentieth of what measuring the main mode took: where it may not, that is not begun.
TEST(Contest, NoneIsMeasuredWhereThatWouldTakeMoreThanItMay) {
    const LitBox box;
    const Goal goal{0.05, 0, Quality::preview, StepClock{}};
    const double start = goal.clock();
    const Contender main = sole_contender(main_mode(), box.view, box.snapshot, box.settings, goal, plain);
    const double alone = goal.clock() - start;
    ASSERT_TRUE(main.reaches_goal());
    const auto measured = [&](double share_of_alone) {
        const double share = share_of_alone * alone / main.seconds;
        return hold_contest(modes(), box.view, box.snapshot, box.settings, goal, share, plain).contenders.size();
    };
    EXPECT_EQ(measured(0.04), 1u);
    EXPECT_GT(measured(0.5), 1u);
}

TEST(Contest, OnlyModesThatOftenWinAreMeasuredInABriefOne) {
    const LitBox box = lamp_in_box();
    const Goal goal{0.002, 0, Quality::preview, StepClock{}};
    const auto others = [&](double share) {
        std::set<std::string_view> names;
        for (const Contender& contender :
             hold_contest(modes(), box.view, box.snapshot, box.settings, goal, share, plain).contenders)
            if (contender.mode != &main_mode()) names.insert(contender.mode->name);
        return names;
    };
    EXPECT_EQ(others(0.2), std::set<std::string_view>{"froxel"});
    EXPECT_GT(others(infinity).size(), 3u);
}

TEST(Contest, WhatIsAlreadyDoneCountsTowardsOneImage) {
    const LitBox box;
    const Goal goal{0.001, 0, Quality::preview, steady_seconds};
    for (const double share : {0.2, 1.0}) {
        const Contest contest = hold_contest(modes(), box.view, box.snapshot, box.settings, goal, share, plain);
        EXPECT_EQ(contest.contenders[0].done > 0, share < 0.25);
        EXPECT_LT(contest.contenders[0].done, contest.contenders[0].seconds);
    }
}

// In the pilot's few tiles, a mode's noise may look many times that of another which is as noisy in the image.
TEST(Contest, ScoutsPredictTheNoiseOfModesThatMayWin) {
    const LitBox box = lamp_in_box();
    const Goal goal{0.005, 0, Quality::preview, StepClock{}};
    const Contest contest = hold_contest(modes(), box.view, box.snapshot, box.settings, goal, infinity, plain);
    const Mode& froxel = find_mode("froxel");
    const Scout main = *make_scout(main_mode(), box.view, box.snapshot,
                                   candidates_of(main_mode(), box.settings, goal.quality)[0], plain, goal.clock);
    int scouted = 0;
    for (const Contender& contender : contest.contenders) {
        if (contender.mode != &froxel || !contender.reaches_goal()) continue;
        const Scout own = *make_scout(froxel, box.view, box.snapshot, contender.choice.candidate, plain, goal.clock);
        EXPECT_NEAR(contender.choice.noise_ratio, std::pow(noise_of(own.layers).error / noise_of(main.layers).error, 2),
                    1e-6);
        ++scouted;
    }
    EXPECT_GT(scouted, 0);
}

TEST(Contest, AVeryLongForecastGrantsTheOthersNoMoreThanTwentyTimesWhatIsKnown) {
    const LitBox box;
    const Goal goal{0.000001, 0, Quality::preview, StepClock{}};
    const double start = goal.clock();
    const Contender main = sole_contender(main_mode(), box.view, box.snapshot, box.settings, goal, plain);
    ASSERT_TRUE(main.reaches_goal());
    ASSERT_GT(main.seconds, 40 * (goal.clock() - start));
    const auto measured = [&](double share) {
        return hold_contest(modes(), box.view, box.snapshot, box.settings, goal, share, plain).contenders.size();
    };
    EXPECT_EQ(measured(0.04 / 20), 1u);
    EXPECT_GT(measured(0.5 / 20), 1u);
}

// A technique that misses the target costs no more than its first round; one that does not renders all of them.
TEST(Contest, AModeThatMissesTheTargetIsStoppedEarly) {
    const LitBox box;
    Goal goal{0.02, 0, Quality::preview, steady_seconds};
    Mode wrong = own_mode(prepare_random); // and noisy: .02 takes some 800 samples a pixel
    wrong.accuracy = main_mode().accuracy, wrong.rungs = main_mode().rungs;
    Choice choice = choose(main_mode(), box.view, box.snapshot, box.settings, goal, goal.clock(), plain);
    Scout scout = *make_scout(wrong, box.view, box.snapshot, choice.candidate, plain, goal.clock);
    choice.scout = std::make_shared<const Scout>(scout), choice.from_contest = true;
    choice.has_integrator = true, choice.is_truth = false;
    choice.measured.integrator = {}, choice.measured.prepared = nullptr;
    goal.choice = std::make_shared<const Choice>(choice);
    const auto rendered = [&](Mode rival) {
        rival.name = "rival";
        FrameStats stats;
        render_to_target(rival, box.view, box.snapshot, box.settings, goal, plain, stats);
        return stats;
    };
    const FrameStats missed = rendered(wrong);
    EXPECT_GT(missed.integrator->error.error, goal.error);
    EXPECT_GT(missed.noise->error, goal.error) << "further rounds would be in vain";
    EXPECT_LE(rendered(main_mode()).error()->bound, goal.error);
}
}

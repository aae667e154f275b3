// What a plan says of the error of its frames.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/adaptive/planned.h"
#include "scene/light.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
FrameStats with_noise(double bound) {
    FrameStats stats;
    stats.noise = Noise{0.8 * bound, bound, bound};
    return stats;
}

// A lit box of fog that scatters most of its light again.
Snapshot milk() { return snapshot_of({homogeneous_medium(0.5f, {vec3(-3), vec3(3)})}, {point_light({0, 2, 0}, 10)}); }

View view_of_milk() {
    View view;
    view.camera = look_at({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 0.9f);
    view.size = {64, 36}, view.pixel_samples = view.batches = 2;
    return view;
}

Settings coarse_settings() {
    Settings settings = settings_for(Quality::draft);
    settings.fluence.orders = all_orders, settings.march.step_depth = 2;
    return settings;
}

TEST(Planned, StepsAndGridsCountWithoutATarget) {
    const Snapshot snapshot = milk();
    const View view = view_of_milk();
    const Settings settings = coarse_settings();
    const PlannedError planned = systematic_error(main_mode(), view, snapshot, settings, {});
    ASSERT_TRUE(planned.integrator && planned.orders);
    EXPECT_GT(planned.integrator->error.error, 0);
    EXPECT_GT(planned.orders->pixels.bound, 0);
    FrameStats stats = with_noise(0.1);
    add_planned_error(planned, main_mode(), view, snapshot, settings, {}, {}, stats);
    EXPECT_EQ(stats.error()->bound, std::hypot(0.1, planned.integrator->error.bound, planned.orders->pixels.bound));

    const PlannedError of_path = systematic_error(mode_of_all_orders(), view, snapshot, settings, {});
    EXPECT_FALSE(of_path.integrator || of_path.orders) << "its only error is noise";
}

TEST(Planned, FinishedImagesOfATargetAreMeasured) {
    const Snapshot snapshot = milk();
    const View view = view_of_milk();
    const Settings settings = coarse_settings();
    PlannedError planned;
    planned.target = 0.1, planned.integrator = Integrator{{}, "too good", settings};
    FrameStats stats;
    const Layers image = render_frame(main_mode(), view, snapshot, settings, {}, stats);
    add_planned_error(planned, main_mode(), view, snapshot, settings, image, {}, stats);
    EXPECT_GT(stats.integrator->error.error, 0);
    EXPECT_EQ(stats.integrator->candidate, "too good");
}

TEST(Planned, GroupsThatLackFollowFromNoise) {
    PlannedError planned;
    planned.target = 0.03;
    EXPECT_EQ(missing_groups(planned, with_noise(0.03), 8), 0);
    EXPECT_EQ(missing_groups(planned, with_noise(0.06), 8), std::ceil(1.05 * 8 * 4) - 8);
    EXPECT_EQ(missing_groups({}, with_noise(1), 8), 0) << "no target was asked for";
}

TEST(Planned, WhatSamplesDoNotRemoveIsLeftOutOfThem) {
    PlannedError planned;
    planned.target = 0.05;
    FrameStats stats = with_noise(0.05);
    stats.integrator = Integrator{{0.02, 0.03}, "draft", {}}; // 0.04 are left
    EXPECT_EQ(missing_groups(planned, stats, 8), std::ceil(1.05 * 8 * 25 / 16.0) - 8);
    stats.integrator->error.bound = 0.05;
    EXPECT_EQ(missing_groups(planned, stats, 8), infinity);
}
}
}

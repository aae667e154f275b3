// The few pixels that tell how wrong a picture will be.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/adaptive/pilot.h"
#include "scene/light.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include "modes/mode.h"
#include "render/adaptive/to_target.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Box room{vec3(-4), vec3(4)};
const FrameOptions plain{};

View view_of(ivec2 size) {
    View view;
    view.camera = look_at({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 0.9f);
    view.size = size, view.pixel_samples = 1;
    return view;
}

Pilot pilot_of(const View& view, const Snapshot& snapshot) {
    const Settings truth = truth_of(Settings{});
    return make_pilot(find_mode("march"), view, snapshot, &truth, plain, [] { return false; });
}

// As the march, but twice as bright within 6 cm of the place.
Mode bright_beside(vec3 place) {
    static vec3 wrong;
    wrong = place;
    Mode mode = find_mode("march");
    mode.prepare = [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
        const ScatterFunction right = main_mode().prepare(view, snapshot, settings, history);
        return ScatterFunction([right](const RayBatch& batch, std::span<Scatter> results) {
            right(batch, results);
            for (size_t i = 0; i < results.size(); ++i) {
                const Ray& ray = batch.rays[i];
                const vec3 to = wrong - ray.origin;
                if (glm::length(to - glm::dot(to, ray.direction) * ray.direction) < 0.06f) results[i].radiance *= 2;
            }
        });
    };
    return mode;
}

TEST(Pilot, TakesTilesAllOverThePictureAndThoseWithALamp) {
    const View view = view_of({640, 360});
    Light beside = point_light({9, 0, 0}), before = point_light({0.3f, -0.7f, 0});
    const Pilot pilot = pilot_of(view, snapshot_of({homogeneous_medium(0.1f, room)}, {beside, before}));
    EXPECT_EQ(pilot.corners.size(), size_t{max_pilot_tiles});
    EXPECT_EQ(pilot.tiles, 160 * 90);
    ASSERT_EQ(pilot.lamp_tiles, 1u) << "the other one is out of the picture";
    const ivec2 lamp(*pixel_of(view.camera, view.size, before.position));
    EXPECT_EQ(pilot.corners[0], lamp / 4 * 4);
    double stood_for = 0;
    for (size_t tile = 0; tile < pilot.corners.size(); ++tile) stood_for += tiles_stood_for(pilot, tile);
    EXPECT_NEAR(stood_for, pilot.tiles, 1e-6);
}

TEST(Pilot, ATinyPictureIsFollowedWhole) {
    const Pilot pilot =
        pilot_of(view_of({3, 2}), snapshot_of({homogeneous_medium(0.1f, room)}, {point_light({0, 0, 0})}));
    EXPECT_EQ(pilot.corners.size(), 1u);
    EXPECT_EQ(pilot.lamp_tiles, 0u) << "no tile is left that others could stand for";
}

// A pixel of 14400 that no other tile would show: its squared error counts as that of one pixel.
TEST(Pilot, SeesWhatIsWrongInALampsPixelAlone) {
    const View view = view_of({160, 90});
    const vec3 place(0.3f, -0.7f, 0);
    const Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, room)}, {point_light(place)});
    const Pilot pilot = pilot_of(view, snapshot);
    const Settings settings = truth_of(Settings{});
    const Measured right = measure(pilot, find_mode("march"), snapshot, settings, plain, steady_seconds);
    const Measured wrong = measure(pilot, bright_beside(place), snapshot, settings, plain, steady_seconds);
    EXPECT_LT(right.integrator.bound, 1e-8);
    EXPECT_GT(wrong.integrator.value, 100 * right.integrator.bound);
    EXPECT_GT(wrong.integrator.bound, wrong.integrator.value);

    // Against whole pictures, which differ there only.
    View centers = view;
    centers.filter = PixelFilter::center;
    FrameStats stats;
    const Layers one = render_frame(find_mode("march"), centers, snapshot, settings, plain, stats);
    const Layers other = render_frame(bright_beside(place), centers, snapshot, settings, plain, stats);
    size_t differing = 0;
    for (size_t i = 0; i < one.color.pixels.size(); ++i) differing += one.color.pixels[i] != other.color.pixels[i];
    EXPECT_GT(differing, 0u);
    EXPECT_LE(differing, 16u);
}

// A frame that glows, with settings of another that did not: it is held against its glow, and gets it back.
TEST(Goal, AFrameIsHeldAgainstTermsThatAnotherDidNotNeed) {
    Medium fog = homogeneous_medium(0.1f, room);
    fog.optics.emission.radiance = vec3(0.02f);
    const Snapshot snapshot = snapshot_of({fog}, {point_light({0, 5, 0}, 20)});
    Settings settings;
    settings.terms.emission = false;
    Goal goal{0.05};
    FrameStats stats;
    const View view = view_of({64, 36});
    render_to_target(find_mode("march"), view, snapshot, settings, goal, plain, stats);
    EXPECT_FALSE(stats.integrator->settings.terms.emission) << "nothing else was asked for";
    goal.wanted = std::make_shared<const Settings>();
    render_to_target(find_mode("march"), view, snapshot, settings, goal, plain, stats);
    EXPECT_TRUE(stats.integrator->settings.terms.emission);
    EXPECT_LE(stats.error()->bound, 0.05);
}
}
}

// What few moments of motion blur are off by, for light that depends on time alone: closed forms.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/adaptive/errors/shutter_error.h"
#include "render/adaptive/to_target.h"
#include "render/fixtures.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
using Light = double (*)(double time); // from 0 to 1 while the shutter is open

Light light;

ScatterFunction prepare_light(const View&, const Snapshot& snapshot, const Settings&, History*) {
    const vec3 radiance(static_cast<float>(light(snapshot.seconds)));
    return [radiance](const RayBatch&, std::span<Scatter> results) {
        for (Scatter& result : results) result = {.radiance = radiance, .transmittance = 1};
    };
}

// An empty scene in so many moments.
struct Blurred {
    Scene scene;
    Snapshot snapshot;
    View view = plain_view({16, 16}, 1, 2);
    Mode mode = mode_of(prepare_light);

    Blurred(Light shown, int moments) {
        light = shown;
        snapshot = snapshot_of(scene);
        auto all = std::make_shared<std::vector<Snapshot>>();
        for (int k = 0; k < moments; ++k) all->push_back(snapshot), all->back().seconds = (k + 0.5) / moments;
        snapshot.moments = all;
        auto shutter = std::make_shared<OpenShutter>();
        shutter->cameras.resize(static_cast<size_t>(moments), view.camera);
        view.shutter = shutter;
    }
};

// As a share of the mean.
double error_of_moments(Light shown, int moments) {
    const Blurred blurred(shown, moments);
    const Settings settings;
    const Prepared prepared = prepare_frame(blurred.mode, blurred.view, blurred.snapshot, settings, nullptr);
    const SquaredError error =
        moments_error(blurred.mode, blurred.view, blurred.snapshot, settings, prepared,
                      uniform_chances(blurred.view, blurred.snapshot), 0.01, false, FrameOptions{});
    EXPECT_GE(error.bound, error.value);
    return std::sqrt(error.value);
}

TEST(MomentsError, OfWhatIsSeenInOneMomentIsAllOfIt) {
    for (const int moments : {4, 8}) {
        const double error =
            error_of_moments([](double time) { return std::abs(time - 0.3) < 0.08 ? 1.0 : 0.0; }, moments);
        EXPECT_NEAR(error, 1, 1e-5) << moments;
    }
}

TEST(MomentsError, OfEvenChangeIsNone) {
    for (const int moments : {4, 8, 32}) {
        EXPECT_NEAR(error_of_moments([](double) { return 2.0; }, moments), 0, 1e-6) << moments;
        EXPECT_NEAR(error_of_moments([](double time) { return 1 + time; }, moments), 0, 1e-5) << moments;
    }
    EXPECT_NEAR(error_of_moments([](double time) { return 1 + time * time; }, 8), 0, 1e-5);
}

TEST(MomentsError, OfAnEdgeIsAMomentOrNone) {
    const auto edge = [](double time) { return time > 0.4 ? 1.0 : 0.0; };
    EXPECT_NEAR(error_of_moments(edge, 4), 0.0, 1e-5) << "which two of the four see";
    EXPECT_NEAR(error_of_moments([](double time) { return time > 0.2 ? 1.0 : 0.0; }, 4), 1.0 / 3, 1e-5);
    EXPECT_NEAR(error_of_moments([](double time) { return time > 0.2 ? 1.0 : 0.0; }, 32), 0.0, 1e-5);
    EXPECT_NEAR(error_of_moments([](double time) { return time > 0.22 ? 1.0 : 0.0; }, 32), 1.0 / 25, 1e-5);
}

// Most of the target: more moments are asked for, in proportion, and nothing is rendered.
TEST(MomentsError, AsksForMoreMoments) {
    Blurred blurred([](double time) { return time > 0.22 ? 1.0 : 0.0; }, 32); // is off by 0.04
    blurred.mode.surfaces = Surfaces::own, blurred.mode.accuracy = Accuracy::multiple_scattering;
    const auto wanted = [&](double target, int most, double seconds = 0) {
        Goal goal{target, seconds};
        goal.moment_limit = most;
        FrameStats stats;
        const Layers layers =
            render_to_target(blurred.mode, blurred.view, blurred.snapshot, Settings{}, goal, {}, stats);
        EXPECT_EQ(layers.color.pixels.empty(), stats.wanted_moments > 0);
        return stats.wanted_moments;
    };
    EXPECT_EQ(wanted(0.05, 512), 64);
    EXPECT_EQ(wanted(0.012, 512), 256);
    EXPECT_EQ(wanted(0.012, 128), 128) << "all there may be";
    EXPECT_EQ(wanted(0.2, 512), 0) << "leaves enough";
    EXPECT_EQ(wanted(0.012, 0), 0) << "as asked for";
    EXPECT_EQ(wanted(0.012, 512, 1), 0) << "the time limit is for samples";
}

// A picture to a target counts it, and says when it is out of reach.
TEST(MomentsError, IsPartOfThePromise) {
    Blurred blurred([](double time) { return time > 0.22 ? 1.0 : 0.0; }, 32);
    blurred.mode.surfaces = Surfaces::own, blurred.mode.accuracy = Accuracy::multiple_scattering;
    for (const double target : {0.2, 0.01}) {
        Goal goal{target};
        FrameStats stats;
        render_to_target(blurred.mode, blurred.view, blurred.snapshot, Settings{}, goal, FrameOptions{}, stats);
        ASSERT_TRUE(stats.moments_error);
        EXPECT_NEAR(stats.moments_error->error, 1.0 / 25, 1e-5);
        EXPECT_GE(stats.error()->bound, 1.0 / 25 - 1e-5);
        EXPECT_EQ(stats.error()->bound <= target, target == 0.2);
    }
}
}
}

// How far multiple scattering from a grid is from path tracing, with grids that are off by what is known.
#include "base/random.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/adaptive/errors/orders.h"
#include "render/adaptive/to_target.h"
#include "render/frame/layers.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/threads.h"
#include "support/tiny_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <limits>

namespace tyndall::test {
namespace {
View view_of(uint32_t seed) {
    View view;
    view.camera = look_at({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 0.9f);
    view.size = {64, 36}, view.pixel_samples = 1, view.seed = seed;
    return view;
}

// A lit box of fog that scatters most of its light again.
Snapshot milk() { return snapshot_of({homogeneous_medium(0.5f, {vec3(-3), vec3(3)})}, {sun_light({0, -1, -0.2f})}); }

Settings all_orders_settings() {
    Settings settings;
    settings.fluence.orders = all_orders;
    return settings;
}

// Path tracing that passes for a mode with a grid: with it, all light is brighter by a share.
template<int percent> Mode off_by() {
    Mode mode = mode_of_all_orders();
    mode.adds_fluence = true, mode.accuracy = Accuracy::single_scattering;
    mode.prepare = [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
        const ScatterFunction right = mode_of_all_orders().prepare(view, snapshot, settings, history);
        const float share = settings.fluence.orders > 1 ? 1 + percent / 100.0f : 1;
        return ScatterFunction([right, share](const RayBatch& batch, std::span<Scatter> results) {
            right(batch, results);
            for (Scatter& result : results) result.radiance *= share;
        });
    };
    return mode;
}

// Path tracing that passes for a mode with a grid, with random numbers of its own.
Mode as_right() {
    Mode mode = off_by<0>();
    mode.prepare = [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
        const ScatterFunction right = mode_of_all_orders().prepare(view, snapshot, settings, history);
        return ScatterFunction([right](const RayBatch& batch, std::span<Scatter> results) {
            std::vector<uint32_t> ids(batch.ids.begin(), batch.ids.end());
            for (uint32_t& id : ids) id = hash(id, 1u);
            RayBatch other = batch;
            other.ids = ids, other.jitter = {}, other.sample_indices = {};
            right(other, results);
        });
    };
    return mode;
}

// The same, twice as bright below a row of pixels.
constexpr int last_row = 32;
Mode off_below() {
    Mode mode = off_by<0>();
    mode.prepare = [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
        const ScatterFunction right = mode_of_all_orders().prepare(view, snapshot, settings, history);
        const int first_wrong = settings.fluence.orders > 1 ? last_row : std::numeric_limits<int>::max();
        return ScatterFunction([right, first_wrong](const RayBatch& batch, std::span<Scatter> results) {
            right(batch, results);
            for (size_t i = 0; i < results.size(); ++i)
                if (batch.positions[i].y >= first_wrong) results[i].radiance *= 2;
        });
    };
    return mode;
}

// The same, brighter and darker by half in turns of two columns: averages over tiles are right.
Mode off_in_stripes() {
    Mode mode = off_by<0>();
    mode.prepare = [](const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
        const ScatterFunction right = mode_of_all_orders().prepare(view, snapshot, settings, history);
        const float off = settings.fluence.orders > 1 ? 0.5f : 0;
        return ScatterFunction([right, off](const RayBatch& batch, std::span<Scatter> results) {
            right(batch, results);
            for (size_t i = 0; i < results.size(); ++i)
                results[i].radiance *= 1 + (static_cast<int>(batch.positions[i].x) & 2 ? off : -off);
        });
    };
    return mode;
}

OrdersError error_of(const Mode& mode, uint32_t seed, double wanted = 0.05) {
    static const Snapshot snapshot = milk();
    return orders_error(mode, view_of(seed), snapshot, all_orders_settings(), wanted, {});
}
}

TEST(Orders, AGridThatIsRightIsFoundSo) {
    // Through the same rays both have the same light: nothing is left to chance.
    const OrdersError error = error_of(off_by<0>(), 1);
    EXPECT_NEAR(error.pixels.error, 0, 1e-6);
    EXPECT_NEAR(error.pixels.bound, 0, 1e-6);
    EXPECT_NEAR(error.mean.error, 0, 1e-6);
}

TEST(Orders, AShareOfAllLightIsFound) {
    // Light 20 % too bright everywhere: the mean is off by that, pixels by it times the rms of the light over its mean,
    // which is at least 1.
    const OrdersError error = error_of(off_by<20>(), 1);
    EXPECT_NEAR(error.mean.error, 0.2, 1e-4);
    EXPECT_NEAR(error.mean.bound, 0.2, 1e-3);
    EXPECT_GE(error.pixels.bound, 0.2);
    EXPECT_GE(error.pixels.error, 0.17);
    EXPECT_LE(error.pixels.bound, 0.6);
}

TEST(Orders, ErrorsThatCancelBetweenNeighborsAreFound) {
    // Half of the light, whose rms over its mean is at least 1.
    const OrdersError error = error_of(off_in_stripes(), 1);
    EXPECT_NEAR(error.mean.error, 0, 0.05);
    EXPECT_GE(error.pixels.bound, 0.5);
    EXPECT_GE(error.pixels.error, 0.43);
    EXPECT_LE(error.pixels.bound, 1.5);
}

TEST(Orders, LightThatScattersOnceHasNoNoiseInIt) {
    // In thin fog little light scatters twice; noise of the rest would be half of all.
    const Snapshot snapshot =
        snapshot_of({homogeneous_medium(0.005f, {vec3(-3), vec3(3)})}, {sun_light({0, -1, -0.2f})});
    const OrdersError error = orders_error(main_mode(), view_of(1), snapshot, all_orders_settings(), 0, {});
    EXPECT_LE(error.pixels.bound, 0.05);
}

TEST(Orders, TilesCountByTheirPixels) {
    // Two rows of pixels are left over at the lower edge: all that is wrong is in them.
    View view = view_of(0);
    view.size.y = last_row + 2;
    const Snapshot snapshot = milk();
    Settings settings;
    settings.path.orders = all_orders;
    view.pixel_samples = 64;
    FrameStats stats;
    const Layers truth = render_frame(mode_of_all_orders(), view, snapshot, settings, {}, stats);
    double below = 0, all = 0;
    for (int y = 0; y < view.size.y; ++y)
        for (int x = 0; x < view.size.x; ++x)
            all += truth.color.at(x, y).x, below += y < last_row ? 0 : truth.color.at(x, y).x;

    constexpr uint32_t count = 16;
    double mean = 0, squares = 0;
    for (view.seed = 1; view.seed <= count; ++view.seed) {
        const double one = orders_error(off_below(), view, snapshot, all_orders_settings(), 0, {}).mean.error;
        mean += one / count, squares += one * one / count;
    }
    // The truth has as many rays: its own standard error is no larger.
    EXPECT_NEAR(mean, below / all, 4 * std::sqrt(2 * (squares - mean * mean) / (count - 1)));
}

TEST(Orders, ImagesOfAnySizeAreLookedAt) {
    // Sizes that leave a single row or column of pixels to the last tiles, or to all.
    const Snapshot snapshot = milk();
    View view = view_of(1);
    for (const ivec2 size : {ivec2(1, 1), ivec2(5, 9), ivec2(9, 1), ivec2(16, 9)}) {
        view.size = size;
        EXPECT_NEAR(orders_error(off_by<20>(), view, snapshot, all_orders_settings(), 0, {}).mean.error, 0.2, 1e-4);
    }
}

TEST(Orders, NoiseAloneIsNoError) {
    // Two that differ by noise only: the estimate's mean is 0, so that it is as often below as above, where the error
    // it stands for is 0. Of 20 at one half, fewer than 4 in one of 700.
    int none = 0;
    for (uint32_t seed = 0; seed < 20; ++seed) {
        const OrdersError error = error_of(as_right(), seed, 0);
        EXPECT_GT(error.pixels.bound, 0);
        none += error.pixels.error == 0;
    }
    EXPECT_GE(none, 4);
}

TEST(Orders, BoundsHold) {
    // Of march's grid, against the mean of many measurements.
    const Mode& march = main_mode();
    constexpr uint32_t count = 20;
    double truth = 0, mean = 0;
    std::vector<OrdersError> all;
    for (uint32_t seed = 0; seed < count; ++seed) {
        all.push_back(error_of(march, seed));
        truth += all.back().pixels.error * all.back().pixels.error / count, mean += all.back().mean.error / count;
    }
    int held = 0, mean_held = 0;
    for (const OrdersError& one : all)
        held += one.pixels.bound >= std::sqrt(truth), mean_held += one.mean.bound >= std::abs(mean);
    EXPECT_GE(held, 18) << std::sqrt(truth); // of 20 at 97.5 %: fewer in one of seventy
    EXPECT_GE(mean_held, 18) << mean;
}

TEST(Orders, HaveTheSameBitsForAnyThreadCount) {
    const auto made = [] { return error_of(main_mode(), 3); };
    const OrdersError one = on_threads(1, made), two = on_threads(2, made);
    EXPECT_EQ(one.mean.bound, two.mean.bound);
    EXPECT_EQ(one.pixels.error, two.pixels.error);
    EXPECT_EQ(one.pixels.bound, two.pixels.bound);
}

TEST(Orders, LeaveTheRestOfAnErrorToNoise) {
    EXPECT_NEAR(*remaining_error({0.02, 0.03}, 0.05), 0.04, 1e-12);
    EXPECT_EQ(remaining_error({0.02, 0.06}, 0.05), std::nullopt);
    EXPECT_EQ(remaining_error({0.02, 0.0499}, 0.05), std::nullopt) << "too little is left to reach";
}

TEST(Orders, CountInWhatATargetPromises) {
    Settings settings = all_orders_settings();
    FrameStats stats;
    const View view = view_of(5);
    const Snapshot snapshot = milk();
    render_to_target(main_mode(), view, snapshot, settings, {0.3, 0, Quality::preview, {}}, {}, stats);
    ASSERT_TRUE(stats.orders && stats.integrator);
    EXPECT_GT(stats.orders->pixels.bound, 0);
    EXPECT_NEAR(stats.error()->bound,
                std::hypot(stats.noise->bound, stats.integrator->error.bound, stats.orders->pixels.bound), 1e-12);
    EXPECT_LE(stats.error()->bound, 0.3);

    settings.fluence.orders = 1;
    render_to_target(main_mode(), view, snapshot, settings, {0.3, 0, Quality::preview, {}}, {}, stats);
    EXPECT_FALSE(stats.orders);
}

TEST(Orders, MissATargetThatTheGridIsTooFarOffFor) {
    // A dark room beside the lit fog: the grid lights no walls, path tracing does.
    Scene scene;
    scene.materials = {lambert(vec3(0.8f))};
    add_mesh(scene, floor_of(-2, 4, 0));
    add_mesh(scene, floor_of(2.5f, 4, 0));
    Snapshot snapshot = snapshot_of({homogeneous_medium(0.1f, {vec3(-3), vec3(3)})}, {point_light({0, 0, 0}, 10)});
    add_surfaces(scene, snapshot);
    FrameStats stats;
    render_to_target(main_mode(), view_of(7), snapshot, all_orders_settings(), {0.1, 0, Quality::preview, {}}, {},
                     stats);
    ASSERT_TRUE(stats.orders);
    EXPECT_LT(stats.orders->mean.error, -0.1);
    EXPECT_GT(stats.error()->bound, 0.1);
}
}

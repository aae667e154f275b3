#include "base/error.h"
#include "base/random.h"
#include "integrate/ray_batch.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/frame/noise_fixtures.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/threads.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
struct Result {
    Layers layers;
    FrameStats stats;
};

Result to_target(const View& view, double target, FrameOptions options = {},
                 const Mode& mode = own_mode(prepare_random)) {
    static const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    Result result;
    result.layers =
        render_to_target(mode, view, snapshot, Settings{}, {target, 0, Quality::preview, {}}, options, result.stats);
    return result;
}

double true_error(int samples) { return std::sqrt(random_variance / samples) / random_mean; }
}

TEST(ToTarget, SamplesComeInBatches) {
    EXPECT_EQ(batched_samples(1), 64);
    EXPECT_EQ(batched_samples(64), 64);
    EXPECT_EQ(batched_samples(65), 128);
    EXPECT_EQ(batched_samples(4096), 4096);
}

TEST(ToTarget, RefusesModesWithOtherErrors) {
    EXPECT_NO_THROW(check_target(own_mode(prepare_random)));
    const std::string text = error_message(ExitCode::usage, [] { check_target(mode_of(prepare_random)); });
    EXPECT_NE(text.find("'test'"), text.npos) << text;
    Mode biased = own_mode(prepare_random);
    biased.accuracy = Accuracy::single_scattering;
    error_message(ExitCode::usage, [&] { check_target(biased); });
}

TEST(ToTarget, KeepsItsPromise) {
    const double target = 0.04;
    const int needed = static_cast<int>(random_variance / std::pow(target * random_mean, 2)); // 208
    View view = plain_view({16, 16}, 4);
    int kept = 0;
    for (uint32_t seed = 0; seed < 20; ++seed) {
        view.seed = seed;
        const Result result = to_target(view, target);
        EXPECT_LE(result.stats.noise->bound, target);
        EXPECT_LT(result.stats.noise->error, result.stats.noise->bound);
        EXPECT_LE(result.stats.samples, needed + 2 * 64) << "no more than rounding and one round too many";
        EXPECT_EQ(result.stats.camera_rays, 256u * result.stats.samples);
        kept += true_error(result.stats.samples) <= target;
    }
    EXPECT_GE(kept, 19);
}

TEST(ToTarget, RoundsAreIndependentAndCombineWithTheirVariances) {
    FrameOptions options;
    options.halves = true;
    const Result result = to_target(plain_view({32, 32}, 4), 0.03, options);
    const Layers& layers = result.layers;
    ASSERT_GE(result.stats.samples, 320) << "several rounds";
    const double expected = random_variance / result.stats.samples;
    double square = 0, covariance = 0;
    for (size_t i = 0; i < layers.color.pixels.size(); ++i) {
        const double error = layers.color.pixels[i].x - random_mean;
        const double a = layers.half_a.pixels[i].x, b = layers.half_b.pixels[i].x;
        square += error * error / 1024, covariance += (a - random_mean) * (b - random_mean) / 1024;
        ASSERT_NEAR((a + b) / 2, layers.color.pixels[i].x, 2e-7);
    }
    EXPECT_NEAR(square, expected, 5 * expected * std::sqrt(2.0 / 1024));
    EXPECT_NEAR(covariance, 0, 5 * 2 * expected / 32);
    // Rounds of unequal weight know their variance at least as well as the first alone.
    EXPECT_NEAR(mean_red(layers.variance), expected, 5 * 0.0036 * expected);
}

TEST(ToTarget, StopsWhereTheFirstRoundIsEnough) {
    const View view = plain_view({16, 16}, 65);
    const Result result = to_target(view, 0.5);
    EXPECT_EQ(result.stats.samples, 128);
    static const Scene scene;
    View plain = view;
    plain.pixel_samples = 128, plain.batches = noise_batches;
    const Layers layers = rendered(own_mode(prepare_random), plain, snapshot_of(scene));
    EXPECT_TRUE(same_bits(result.layers.color, layers.color));
}

TEST(ToTarget, SaysWhenItWasMissed) {
    const Result result = to_target(plain_view({2, 2}, 4), 1e-4);
    EXPECT_EQ(result.stats.samples, max_target_samples);
    EXPECT_GT(result.stats.noise->bound, 1e-4);
    EXPECT_NEAR(result.stats.noise->error, true_error(max_target_samples), 0.2 * true_error(max_target_samples));
}

TEST(ToTarget, HasTheSameBitsForAnyThreadCount) {
    const View view = plain_view({40, 36}, 4);
    const auto made = [&] { return to_target(view, 0.04); };
    const Result one = on_threads(1, made), two = on_threads(2, made);
    EXPECT_TRUE(same_bits(one.layers.color, two.layers.color));
    EXPECT_TRUE(same_bits(one.layers.variance, two.layers.variance));
    EXPECT_EQ(one.stats.noise->bound, two.stats.noise->bound);
}

TEST(ToTarget, ProgressOnlyGrows) {
    std::vector<double> said;
    FrameOptions options;
    options.progress = [&](double share) { said.push_back(share); };
    on_threads(1, [&] { return to_target(plain_view({64, 64}, 4), 0.03, options); });
    ASSERT_GT(said.size(), 12u); // rounds of four blocks
    EXPECT_TRUE(std::ranges::is_sorted(said));
    EXPECT_GT(said.front(), 0);
    EXPECT_EQ(said.back(), 1);
    // After the first round it goes by what the noise asks for: the next four blocks are no longer a trifle.
    EXPECT_LT(said[3], 0.01);
    EXPECT_GT(said[7], 0.1);
}

TEST(ToTarget, StopsWhenCancelled) {
    std::atomic<bool> cancel = true;
    FrameOptions options;
    options.cancel = &cancel;
    EXPECT_THROW(to_target(plain_view({64, 64}, 1), 0.1, options), Error);
}

namespace {
// Not finite at the left edge in the second round only.
ScatterFunction prepare_broken_later(const View& view, const Snapshot&, const Settings&, History*) {
    return [broken = view.seed != 0](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) {
            const bool nan = broken && batch.rays[i].origin.x < -0.875f;
            results[i] = {vec3(nan ? NAN : to_unit(batch.ids[i])), 1, 1, 1};
        }
    };
}
}

TEST(ToTarget, CountsSamplesThatAreNotFinite) {
    View view = plain_view({16, 16}, 64, 2.0f);
    const Result result = to_target(view, 0.06, {}, own_mode(prepare_broken_later));
    EXPECT_EQ(result.stats.non_finite, 16u * (result.stats.samples - 64));
    EXPECT_EQ(result.stats.first_non_finite, ivec2(0, 0));
}
}

// Samples go where pictures spread: by hand, then in pictures that are rendered until they are right.
#include "base/random.h"
#include "integrate/ray_batch.h"
#include "modes/mode.h"
#include "render/adaptive/allotment.h"
#include "render/adaptive/to_target.h"
#include "render/frame/noise_fixtures.h"
#include "scene/scene.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>

namespace tyndall::test {
namespace {
// Two columns of tiles side by side, of mean 1 and of these variances; by default so many that none counts for much.
constexpr int many_rows = 4096, pixels_of_many = 32 * many_rows;
Layers two_columns(float left, float right, int rows = many_rows) {
    Layers layers;
    layers.display = layers.size = {8, 4 * rows};
    layers.color = layers.inscatter = Image<vec3>(layers.size, vec3(1));
    layers.variance = layers.inscatter_variance = Image<vec3>(layers.size);
    for (int y = 0; y < layers.size.y; ++y)
        for (int x = 0; x < 8; ++x) layers.variance.at(x, y) = vec3(x < 4 ? left : right);
    return layers;
}

constexpr double endless = 1e12;
constexpr double near = 0.005; // what 3.6 / sqrt(pixels) of caution for single tiles moves, at most

TEST(Allotment, FollowsTheStandardDeviation) {
    // (1 / n + 9 / 3n) / 2 = 2 / n = 0.02: n = 100.
    const Allotment allotment = allot(two_columns(1, 9), 1, {0.02, endless}, 1, 2);
    EXPECT_NEAR(allotment.samples.at(0, 0), 100, 100 * near);
    EXPECT_NEAR(allotment.samples.at(1, 0), 300, 300 * near);
    EXPECT_NEAR(allotment.rays, pixels_of_many * 200, pixels_of_many * 200 * near);
    EXPECT_NEAR(allotment.squared_error, 0.02, 1e-6);
}

TEST(Allotment, KnowsHowManySamplesTheVariancesStandFor) {
    const Allotment allotment = allot(two_columns(1, 9), 5, {0.02, endless}, 1, 2);
    EXPECT_NEAR(allotment.samples.at(1, 0), 1500, 1500 * near);
    Image<float> taken = uniform_samples(two_columns(1, 1), 3);
    for (int row = 0; row < many_rows; ++row) taken.at(1, row) = 27;
    const Allotment uneven = allot(two_columns(1, 1), taken, {0.06, endless}, 1, 2);
    EXPECT_NEAR(uneven.samples.at(0, 0), 100, 100 * near) << "27 samples with a variance of 1 spread as one of 27";
    EXPECT_NEAR(uneven.samples.at(1, 0), 300, 300 * near);
}

TEST(Allotment, TakesTheWorseOfColorAndFog) {
    Layers layers = two_columns(1, 1);
    for (vec3& value : layers.inscatter.pixels) value = vec3(0.5f); // of its squared mean, four times the variance
    layers.inscatter_variance = layers.variance;
    EXPECT_NEAR(allot(layers, 1, {0.02, endless}, 1, 2).samples.at(0, 0), 200, 1e-2);
}

TEST(Allotment, StaysWithinTheRaysThereAre) {
    const Allotment allotment = allot(two_columns(1, 9), 1, {0.02, pixels_of_many * 20.0}, 1, 2);
    EXPECT_NEAR(allotment.rays, pixels_of_many * 20, 1);
    EXPECT_NEAR(allotment.squared_error, 0.2, 0.2 * near);
}

TEST(Allotment, CountsWhatTilesCost) {
    Layers layers = two_columns(1, 9);
    layers.work = Image<float>(layers.size);
    for (int y = 0; y < layers.size.y; ++y)
        for (int x = 0; x < 8; ++x) layers.work.at(x, y) = x < 4 ? 20.0f : 80.0f; // .4 and 1.6 of the mean
    // Samples as deviation / sqrt(cost): n and 3n / 2; (1 / n + 9 / 1.5n) / 2 = 3.5 / n = 0.02.
    const Allotment allotment = allot(layers, 1, {0.02, endless}, 1, 2);
    EXPECT_NEAR(allotment.samples.at(0, 0), 175, 175 * near);
    EXPECT_NEAR(allotment.samples.at(1, 0), 262.5, 262.5 * near);
    EXPECT_NEAR(allotment.rays, pixels_of_many * (0.4 * 175 + 1.6 * 262.5) / 2, pixels_of_many * 245 * near);
}

TEST(Allotment, GoesByThePowerOfTheSamples) {
    // Samples as variance^(1 / 2.5).
    const Allotment allotment = allot(two_columns(1, 9), 1, {0.02, endless}, 1.5, 2);
    EXPECT_NEAR(allotment.samples.at(1, 0) / allotment.samples.at(0, 0), std::pow(9, 0.4), 3 * near);
    EXPECT_NEAR(allotment.squared_error, 0.02, 1e-6);
}

TEST(Allotment, DoesNotTrustTilesThatShowNoNoise) {
    const Allotment beside = allot(two_columns(0, 16), 1, {0.02, endless}, 1, 2);
    EXPECT_NEAR(beside.samples.at(0, 0) / beside.samples.at(1, 0), 0.25, near);
    const Allotment least = allot(two_columns(0, 0), 1, {0.02, endless}, 1, 6);
    EXPECT_EQ(least.samples.at(0, 0), 6);
}

TEST(Allotment, EndsWhereTilesThatHoldTheErrorCanHaveNoMore) {
    Layers layers = two_columns(0.1f, 0.1f);
    for (int i = 0; i < 16; ++i) layers.variance.at(i % 4, i / 4) = vec3(1e6f);
    const Allotment allotment = allot(layers, 1, {1e-3, endless}, 1, 2);
    EXPECT_EQ(allotment.samples.at(0, 0), max_tile_samples);
    EXPECT_GT(allotment.squared_error, 1e-3);
    EXPECT_LT(allotment.rays, pixels_of_many * 0.01 * max_tile_samples) << "all pixels would have to have as many";
}

// One pixel holds nearly all of the error, so that chance may make it much larger than it is on the average.
TEST(Allotment, MakesTheBoundSmallWhereFewPixelsCount) {
    Layers layers = two_columns(1, 1, 64);
    layers.variance.at(5, 9) = vec3(40'000);
    const double rays = 32 * 64 * 40;
    const Allotment allotment = allot(layers, 1, {0, rays, 0}, 1, 2);
    EXPECT_GT(allotment.squared_bound, allotment.squared_error);
    const auto with_factor = [&](float factor) { // of the samples of the pixel's tile, at the same cost
        Image<float> samples = allotment.samples;
        samples.at(1, 2) *= factor;
        double taken = 0, sum = 0, squares = 0;
        for (const float n : samples.pixels) taken += 16 * double{n};
        for (int y = 0; y < layers.size.y; ++y)
            for (int x = 0; x < 8; ++x) {
                const double n = samples.at(x / 4, y / 4) * rays / taken;
                const double variance = double{layers.variance.at(x, y).x} / n;
                sum += variance, squares += variance * variance;
            }
        return sum + 2.576 * std::sqrt(2 * squares);
    };
    EXPECT_GT(with_factor(0.47f), 1.1 * with_factor(1)) << "as its deviation alone would have it";
    for (const float factor : {0.8f, 1.5f, 2.0f}) EXPECT_GT(with_factor(factor), 0.98 * with_factor(1)) << factor;
}

TEST(Allotment, CountsNoMorePixelsThanHoldTheLight) {
    Layers layers = two_columns(1, 1, 64);
    const AllotLimits limits{0.02, endless};
    EXPECT_NEAR(allot(layers, 1, limits, 1, 2).pixels, 32 * 64, 1) << "all alike";
    // A lamp of which two samples happened to agree: 49 of 49 + 2047 parts of the squared light.
    layers.inscatter.at(3, 3) = vec3(7);
    const double squares = 49 + 2047, fourths = 49 * 49 + 2047;
    EXPECT_NEAR(allot(layers, 1, limits, 1, 2).pixels, squares * squares / fourths, 1);
}

TEST(Allotment, IsRenderedInPartsThatAddUp) {
    Allotment allotment;
    allotment.samples = Image<float>({2, 1});
    allotment.samples.pixels = {99.5f, 298.5f};
    const AllottedPart whole = allotted_part(allotment, 0, 1, 2, false),
                       half = allotted_part(allotment, 0, 0.5, 2, false),
                       rest = allotted_part(allotment, 0.5, 1, 2, false),
                       least = allotted_part(allotment, 0, 1e-6, 2, false);
    EXPECT_EQ(whole.factors->at({0, 0}), 52) << "50 in whole batches";
    EXPECT_EQ(whole.factors->at({1, 0}), 152);
    EXPECT_EQ(half.factors->at({0, 0}), 28);
    EXPECT_EQ(half.factors->at({1, 0}), 76);
    EXPECT_EQ(rest.factors->at({1, 0}), 76);
    EXPECT_FLOAT_EQ(rest.shares.shares.at(1, 0), 0.5f);
    EXPECT_EQ(least.factors->at({1, 0}), 1);
    EXPECT_FLOAT_EQ(least.shares.shares.at(1, 0), 1.0f);
    EXPECT_EQ(allotted_part(allotment, 1e-6, 2e-6, 2, false).factors->at({1, 0}), 0)
        << "rounding up has given it already";

    View view = plain_view({8, 4}, 2);
    view.allotted = whole.factors;
    EXPECT_EQ(samples_of(view, {7, 3}), 304);
}

// Where most samples go, most of the error is: two batches would tell it with one degree of freedom.
TEST(Allotment, TilesOfManySamplesHaveMoreBatches) {
    auto factors = std::make_shared<TileFactors>();
    factors->factors = Image<uint16_t>({4, 1});
    factors->factors.pixels = {1, 7, 8, 9};
    View view = plain_view({16, 4}, 2);
    view.batches = 2, view.allotted = factors;
    EXPECT_EQ(batches_of(view, {0, 0}), 2);
    EXPECT_EQ(batches_of(view, {4, 0}), 2);
    EXPECT_EQ(batches_of(view, {8, 0}), 8);
    EXPECT_EQ(batches_of(view, {12, 0}), 2) << "no whole batches";
    std::set<uint32_t> sequences;
    for (int sample = 0; sample < 16; ++sample) sequences.insert(sample_index(view, {8, 0}, sample).sequence);
    EXPECT_EQ(sequences.size(), 8u);
}

// Gray noise in the upper left corner of four tiles, as prepare_random; a constant elsewhere.
constexpr ivec2 size(64, 64);
std::atomic<int64_t> corner_rays = 0;
ScatterFunction prepare_noisy_corner(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        corner_rays += static_cast<int64_t>(batch.rays.size());
        for (size_t i = 0; i < results.size(); ++i) {
            const bool noisy = batch.positions[i].x < 8 && batch.positions[i].y < 8;
            results[i] = {vec3(noisy ? to_unit(batch.ids[i]) : 0.5f), 1, 1, 1};
        }
    };
}

// Light of 2 in one of 4096 samples of a corner of 16 tiles: the first round sees it in few of them.
constexpr double spark_chance = 1.0 / 4096;
ScatterFunction prepare_sparks(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) {
            const bool in_corner = batch.positions[i].x < 16 && batch.positions[i].y < 16;
            const bool bright = in_corner && to_unit(batch.ids[i]) < static_cast<float>(spark_chance);
            results[i] = {vec3(bright ? 2.0f : 0.5f), 1, 1, 1};
        }
    };
}

struct Result {
    Layers layers;
    FrameStats stats;
};

using Prepare = ScatterFunction (*)(const View&, const Snapshot&, const Settings&, History*);

Result to_target(double target, uint32_t seed, Prepare prepare = prepare_noisy_corner) {
    static const Scene scene;
    View view = plain_view(size, 4);
    view.seed = seed;
    Result result;
    result.layers = render_to_target(own_mode(prepare), view, snapshot_of(scene), Settings{},
                                     {target, 0, Quality::preview, {}}, {}, result.stats);
    return result;
}

TEST(Allotment, NoiseInACornerCostsRaysThereOnly) {
    // With all pixels alike: variance 1/12 over 64 of 4096 pixels, mean 1/2.
    const double target = 0.002,
                 alike = random_variance * 64 / 4096 / std::pow(target * random_mean, 2); // 1302 samples
    int kept = 0;
    double mean = 0, squares = 0;
    constexpr int pictures = 20;
    for (uint32_t seed = 0; seed < pictures; ++seed) {
        const Result result = to_target(target, seed);
        EXPECT_LE(result.stats.noise->bound, target);
        EXPECT_LT(static_cast<double>(result.stats.camera_rays), 0.25 * alike * 4096);
        double square = 0, corner = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const double off = result.layers.color.at(x, y).x - random_mean;
                square += off * off / 4096;
                if (x < 8 && y < 8) corner += off / 64;
            }
        kept += std::sqrt(square) / random_mean <= target;
        mean += corner / pictures, squares += corner * corner / pictures;
    }
    EXPECT_GE(kept, 19);
    EXPECT_LT(std::abs(mean), 4 * std::sqrt(squares / pictures)) << "what decides where rays go must not bias them";
}

TEST(Allotment, IsMadeAnewWhereTheFirstRoundMissedMost) {
    // Samples in the corner alone: variance 1.5² / 4096 over 256 of 4096 pixels, mean 1/2.
    const double target = 0.00025, variance = 1.5 * 1.5 * spark_chance,
                 least = 256 * variance / 16 / std::pow(target * 0.5, 2);
    double rays = 0;
    for (uint32_t seed = 0; seed < 10; ++seed) {
        const Result result = to_target(target, seed, prepare_sparks);
        EXPECT_LE(result.stats.noise->bound, target);
        rays += static_cast<double>(result.stats.camera_rays) / 10;
    }
    EXPECT_LT(rays, 7 * least) << "ten times as many by the first round alone";
}

TEST(Allotment, IsNotMadeAnewForAGoalOutOfReach) {
    static const Scene scene;
    const auto error_after = [](double target, double rays, uint32_t seed) {
        View view = plain_view(size, 4);
        view.seed = seed;
        FrameStats stats;
        const Goal goal{target, rays, Quality::preview, [] { return static_cast<double>(corner_rays); }};
        render_to_target(own_mode(prepare_noisy_corner), view, snapshot_of(scene), Settings{}, goal, {}, stats);
        return stats.noise->error;
    };
    double with_goal = 0, without = 0;
    for (uint32_t seed = 0; seed < 3; ++seed)
        with_goal += error_after(1e-5, 4e6, seed), without += error_after(0, 4e6, seed);
    EXPECT_LT(with_goal, 1.3 * without);
}

TEST(Allotment, SaysHowManySamplesThereAreOnTheAverage) {
    const Result result = to_target(0.002, 3);
    EXPECT_LT(result.stats.samples, 300); // of 1302 if all pixels were alike
    EXPECT_GE(result.stats.camera_rays, 4096u * static_cast<uint64_t>(result.stats.samples));
}
}
}

#include "base/random.h"
#include "modes/mode.h"
#include "render/frame/layers.h"
#include "render/frame/noise_fixtures.h"
#include "render/frame/pixel_sum.h"
#include "scene/light.h"
#include "scene/lights/light_kind.h"
#include "scene/scene.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
TEST(Noise, RunningMeanMatchesHandComputation) {
    RunningMean mean;
    mean.add(vec3(1, 0, 2));
    EXPECT_EQ(mean.variance(), vec3(0));
    for (const float value : {3.0f, 5.0f, 7.0f}) mean.add(vec3(value, 0, 2));
    EXPECT_DOUBLE_EQ(mean.mean.x, 4);
    // Deviations -3, -1, 1, 3: their squares sum to 20, over 4·3.
    EXPECT_FLOAT_EQ(mean.variance().x, 20.0f / 12);
    EXPECT_EQ(mean.variance().y, 0);
    EXPECT_EQ(mean.variance().z, 0);
}

TEST(Noise, RunningSpreadMatchesHandComputation) {
    RunningSpread spread;
    for (const float value : {1.0f, 3.0f}) spread.add(vec3(value));
    // Two values: the square of the variance of their mean, 1.
    EXPECT_FLOAT_EQ(spread.variance_error(), 1);
    for (const float value : {5.0f, 7.0f}) spread.add(vec3(value));
    // Deviations -3, -1, 1, 3: fourth powers sum to 164, over 4·3³.
    EXPECT_FLOAT_EQ(spread.variance_error(), 164.0f / 108);
    // One value of 64 makes all of the variance.
    RunningSpread lone;
    for (int i = 0; i < 64; ++i) lone.add(vec3(i == 40 ? 1.0f : 0.0f));
    EXPECT_NEAR(std::sqrt(lone.variance_error()) / lone.variance().x, 1, 0.02);
}

namespace {
// With variances that are known to a `doubt` of themselves.
Layers homogeneous_layers(ivec2 size, float color, float variance, float fog, float fog_variance,
                          float doubt = std::sqrt(2.0f)) {
    Layers layers;
    const auto squared = [&](float v) { return Image<float>(size, doubt * doubt * v * v); };
    layers.color = Image<vec3>(size, vec3(color)), layers.variance = Image<vec3>(size, vec3(variance));
    layers.inscatter = Image<vec3>(size, vec3(fog)), layers.inscatter_variance = Image<vec3>(size, vec3(fog_variance));
    layers.variance_error = squared(variance), layers.inscatter_variance_error = squared(fog_variance);
    return layers;
}

// Of so many pixels alike: F where both have as many degrees of freedom, for which Wilson & Hilferty's cube roots are
// x² (A² - z²a) - 2 A² x + (A² - z²a) = 0, A = 1 - a.
double bound_over_error(double pixels, double doubt) {
    const double a = 2 / (9 * pixels), A = (1 - a) * (1 - a), z = 2.576 * 2.576 * a;
    EXPECT_NEAR(2 / (doubt * doubt), 1, 1e-6) << "as many degrees of freedom for either";
    return std::pow((A + std::sqrt(A * A - (A - z) * (A - z))) / (A - z), 1.5);
}
}

TEST(Noise, IsTheStandardErrorOverTheMeanOfTheWorseLayer) {
    Noise noise = noise_of(homogeneous_layers({32, 32}, 2, 0.04f, 1, 0.0025f));
    EXPECT_NEAR(noise.error, 0.1, 1e-7);
    EXPECT_NEAR(noise.bound, 0.1 * bound_over_error(1024, std::sqrt(2.0)), 1e-6);
    noise = noise_of(homogeneous_layers({32, 32}, 2, 0.04f, 1, 0.09f));
    EXPECT_NEAR(noise.error, 0.3, 1e-7);
    noise = noise_of(homogeneous_layers({5, 3}, 2, 0.04f, 0, 0));
    EXPECT_NEAR(noise.error, 0.1, 1e-7);
    // Known for sure, one pixel's error is within 2.81 deviations of a normal distribution in 99.5 %.
    noise = noise_of(homogeneous_layers({1, 1}, 2, 0.04f, 0, 0, 1e-4f));
    EXPECT_NEAR(noise.bound, 0.1 * 2.81, 0.005);
    noise = noise_of(homogeneous_layers({4, 4}, 0, 0, 0, 0));
    EXPECT_EQ(noise.error, 0);
    EXPECT_EQ(noise.bound, 0);
    EXPECT_TRUE(std::isinf(noise_of(homogeneous_layers({4, 4}, 0, 1, 0, 0)).error));
}

TEST(Noise, IsLessSureWhereFewPixelsHoldItOrFewBatchesTell) {
    Layers layers = homogeneous_layers({32, 32}, 1, 0, 0, 0);
    const auto over_error = [&](int pixels, float doubt) {
        for (int x = 0; x < 32; ++x) {
            layers.variance.at(x, 9) = vec3(x < pixels ? 1 : 0);
            layers.variance_error.at(x, 9) = x < pixels ? doubt * doubt : 0;
        }
        const Noise noise = noise_of(layers);
        return noise.bound / noise.error;
    };
    // Square roots of tabled F at 0.995: (10, ∞), (30, 30), (10, 20), (4, 12).
    EXPECT_NEAR(over_error(10, 1e-3f), std::sqrt(2.52), 0.02);
    EXPECT_NEAR(over_error(30, std::sqrt(2.0f)), std::sqrt(2.63), 0.02);
    EXPECT_NEAR(over_error(10, 1), std::sqrt(3.85), 0.03);
    EXPECT_NEAR(over_error(4, std::sqrt(2.0f / 3)), std::sqrt(6.52), 0.05);
    EXPECT_GT(over_error(1, 1), 4);
    EXPECT_TRUE(std::isfinite(over_error(1, 1)));
    // The last pixel's, known for certain, is χ² of one degree of freedom: 2.81 deviations.
    EXPECT_NEAR(noise_of(layers).settled / noise_of(layers).error, 2.81, 0.05);
}

TEST(Noise, StaysBelowItsBoundWhereFewSamplesHoldIt) {
    // One sample of 20 is bright, in a quarter of the pixels only: the true error of 2 samples a pixel, taken by two
    // batches, in 400 pictures. The bound may be broken in 0.5 % of them, and 1.5 % for chance.
    const double p = 0.05, variance = 0.25 * p * (1 - p) / 2;
    int broken = 0;
    for (uint32_t picture = 0; picture < 400; ++picture) {
        Layers layers = homogeneous_layers({32, 32}, 1, 0, 0, 0);
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                RunningSpread spread;
                for (uint32_t k = 0; k < 2; ++k) {
                    const uint32_t u = hash(picture, static_cast<uint32_t>(y * 32 + x), k);
                    spread.add(vec3(to_unit(u) < p ? 1.0f : 0.0f));
                }
                layers.variance.at(x, y) = spread.variance(), layers.variance_error.at(x, y) = spread.variance_error();
            }
        broken += noise_of(layers).bound < std::sqrt(variance);
    }
    EXPECT_LE(broken, 0.02 * 400);
}

TEST(Noise, ErrorsOfPicturesStayBelowTheBoundWhereFewPixelsHoldThem) {
    // Ten pixels with normal noise, known from two batches. In 1000 pictures, the bound may be broken in 0.5 %, and
    // 0.7 % for chance.
    int broken = 0;
    for (uint32_t picture = 0; picture < 1000; ++picture) {
        Layers layers = homogeneous_layers({32, 32}, 1, 0, 0, 0);
        double squared = 0;
        for (int x = 0; x < 10; ++x) {
            RunningSpread spread;
            for (uint32_t k = 0; k < 2; ++k) {
                float normal = -6; // Irwin & Hall
                for (uint32_t i = 0; i < 12; ++i)
                    normal += static_cast<float>(to_unit(hash(picture, static_cast<uint32_t>(x), k, i)));
                spread.add(vec3(normal));
            }
            squared += spread.mean.x * spread.mean.x / 1024;
            layers.variance.at(x, 5) = spread.variance(), layers.variance_error.at(x, 5) = spread.variance_error();
        }
        broken += noise_of(layers).bound < std::sqrt(squared);
    }
    EXPECT_LE(broken, 12);
}

// Edges that cross an image at any angle, 20 times as bright on one side, seen by one point of each pixel.
TEST(Noise, NeighborsTellThatOfAnEdge) {
    double told = 0, is = 0;
    for (uint32_t image = 0; image < 64; ++image) {
        const float angle = 2 * pi * to_unit(hash(image, 1u)), away = 20 * to_unit(hash(image, 2u));
        const auto value = [&](vec2 at) {
            return std::cos(angle) * (at.x - 32) + std::sin(angle) * (at.y - 32) < away ? 0.05f : 1.0f;
        };
        Layers layers = homogeneous_layers({64, 64}, 0, 0, 1, 0);
        double variance = 0, mean = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const auto sample = [&](uint32_t k) {
                    const uint32_t pixel = static_cast<uint32_t>(64 * y + x);
                    return value(vec2(x, y) +
                                 vec2(to_unit(hash(image, pixel, k, 0u)), to_unit(hash(image, pixel, k, 1u))));
                };
                layers.color.at(x, y) = vec3(sample(0));
                double sum = 0, squares = 0;
                for (uint32_t k = 1; k <= 16; ++k) sum += sample(k), squares += sample(k) * sample(k);
                variance += (squares - sum * sum / 16) / 15, mean += sum / 16;
            }
        const Noise noise = noise_by_neighbors(layers);
        const double error = 64 * std::sqrt(variance) / mean; // over the mean, of 64² pixels
        EXPECT_GT(noise.bound, error) << image;
        told += noise.error, is += error;
    }
    EXPECT_NEAR(told / is, 1, 0.15);
}

TEST(Noise, NeighborsTellMoreThanThatOfPixelsAlike) {
    Layers layers = homogeneous_layers({64, 64}, 0, 0, 1, 0);
    for (size_t i = 0; i < 64 * 64; ++i) layers.color.pixels[i] = vec3(to_unit(hash(static_cast<uint32_t>(i), 5u)));
    const double error = std::sqrt(1 / 12.0) / 0.5; // of even numbers between 0 and 1
    const Noise noise = noise_by_neighbors(layers);
    EXPECT_GT(noise.bound, error);
    EXPECT_LT(noise.bound, 1.1 * error);
    EXPECT_EQ(noise_by_neighbors(homogeneous_layers({4, 4}, 2, 0, 1, 0)).bound, 0);
}

TEST(Noise, VarianceIsThatOfTheMean) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    for (const Mode& mode : {mode_of(prepare_random), own_mode(prepare_random)})
        for (const int samples : {64, 192}) {
            const Layers layers = rendered(mode, batched_view({32, 32}, samples, 64), snapshot);
            // The variance of even numbers, found from 64 of them, is known to √((9/5 - 61/63)/64) = 0.114 of itself
            // (less for means of three); from 1024 pixels to 0.0036. Five of those.
            const double expected = random_variance / samples;
            EXPECT_NEAR(mean_red(layers.variance), expected, 5 * 0.0036 * expected);
            EXPECT_NEAR(mean_red(layers.inscatter_variance), expected, 5 * 0.0036 * expected);
            EXPECT_NEAR(mean_red(layers.color), random_mean, 5 * std::sqrt(expected / 1024));
        }
}

TEST(Noise, OneBatchHasNoVariance) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    FrameStats stats;
    View view = batched_view({8, 8}, 4, 1);
    const Layers layers = render_frame(mode_of(prepare_random), view, snapshot, Settings{}, {}, stats);
    EXPECT_TRUE(layers.variance.empty());
    EXPECT_TRUE(layers.half_a.empty());
    EXPECT_FALSE(stats.noise.has_value());
    view.batches = 2;
    render_frame(mode_of(prepare_random), view, snapshot, Settings{}, {}, stats);
    EXPECT_TRUE(stats.noise.has_value());
    EXPECT_EQ(stats.samples, 4);
}

TEST(Noise, HalvesAreIndependentAndAverageToTheColor) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    FrameOptions options;
    options.halves = true;
    const int samples = 128;
    const Layers layers = rendered(own_mode(prepare_random), batched_view({64, 64}, samples, 64), snapshot, options);
    double covariance = 0, square = 0;
    for (size_t i = 0; i < layers.color.pixels.size(); ++i) {
        const double a = layers.half_a.pixels[i].x, b = layers.half_b.pixels[i].x;
        ASSERT_NEAR((a + b) / 2, layers.color.pixels[i].x, 1e-7);
        covariance += (a - random_mean) * (b - random_mean);
        square += (a - random_mean) * (a - random_mean);
    }
    // Of 4096 products of independent halves, each of variance 1/12 over 64 samples.
    const double variance = random_variance / (samples / 2);
    EXPECT_NEAR(covariance / 4096, 0, 5 * variance / 64);
    EXPECT_NEAR(square / 4096, variance, 5 * variance * std::sqrt(2.0 / 4096));
}

namespace {
// The variance a picture claims for its means against how the means of many seeds differ.
void expect_honest_variance(const Mode& mode, const Snapshot& snapshot, const View& view) {
    constexpr int seeds = 40;
    std::vector<RunningMean> means(static_cast<size_t>(view.size.x) * view.size.y);
    std::vector<double> claimed(means.size());
    View seeded = view;
    for (int seed = 0; seed < seeds; ++seed) {
        seeded.seed = static_cast<uint32_t>(seed);
        const Layers layers = rendered(mode, seeded, snapshot);
        for (size_t i = 0; i < means.size(); ++i) {
            means[i].add(layers.color.pixels[i]);
            claimed[i] += layers.variance.pixels[i].x / seeds;
        }
    }
    // Each pixel's variance is known to √(2/(seeds-1)) of itself.
    double found = 0, wanted = 0, squares = 0;
    for (size_t i = 0; i < means.size(); ++i) {
        found += means[i].squares.x / (seeds - 1), wanted += claimed[i];
        squares += claimed[i] * claimed[i];
    }
    ASSERT_GT(wanted, 0);
    EXPECT_NEAR(found, wanted, 5 * std::sqrt(2.0 / (seeds - 1) * squares));
}
}

// Were batches not independent, well spread samples would make them differ more than their mean does.
TEST(Noise, BatchesOfEveryRandomNumberAreIndependent) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    const View view = batched_view({16, 16}, 64, 16);
    expect_honest_variance(mode_of(prepare_random), snapshot, view);
    expect_honest_variance(mode_of(prepare_jitter), snapshot, view);
    expect_honest_variance(mode_of(prepare_place), snapshot, view);
}

TEST(Noise, BatchesOfPixelPositionsAreIndependent) {
    Scene scene;
    add_plane(scene, -3, 0.83f, vec3(1));
    for (vec3& position : scene.meshes[0].positions) position = vec3(position.x + 0.3f * position.y, position.y, -3);
    const Snapshot snapshot = snapshot_of(scene);
    expect_honest_variance(mode_of(prepare_nothing), snapshot, batched_view({16, 16}, 64, 16));
}

TEST(Noise, BatchesOfSoftLightAreIndependent) {
    // A wall, a card that shades part of it, and a large lamp.
    Scene scene;
    add_plane(scene, -3, 5, vec3(0));
    scene.materials[0].base_color = vec3(1);
    add_plane(scene, 1, 0.8f, vec3(0));
    Snapshot snapshot = snapshot_of(scene);
    Light light;
    light.name = "lamp", light.kind = LightKind::point, light.position = vec3(0.3f, 0.2f, 3), light.radius = 1;
    light.intensity = vec3(100);
    snapshot.lights.push_back(light);
    expect_honest_variance(mode_of(prepare_nothing), snapshot, batched_view({16, 16}, 64, 16));
}
}

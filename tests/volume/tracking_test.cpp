// Null-collision tracking against exact optical depths, and sampled directions against the phase functions.
#include "volume/tracking.h"

#include "volume/fog_fixtures.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall::test {
namespace {
constexpr double limit = 4.5; // standard errors: chance of a false alarm 7e-6

struct Mean {
    double sum = 0, squares = 0;
    int count = 0;

    void add(double x) { sum += x, squares += x * x, ++count; }
    double value() const { return sum / count; }
    double error() const { return std::sqrt(std::max(0.0, squares / count - value() * value()) / count); }
};

SparseVolume holey_volume() {
    SparseVolume volume = volume_of(ivec3(0), ivec3(31), [](int x, int y, int z) {
        return (x / 8 + y / 8 + z / 8) % 3 ? exact_noise(x, y, z) : 0.0f;
    });
    volume.tiles.push_back({ivec3(32, 0, 0), ivec3(47, 31, 31), 0.25f});
    volume.active_high = ivec3(47, 31, 31);
    volume.index_to_world = glm::scale(glm::rotate(dmat4(1), 0.4, glm::normalize(dvec3(1, 1, 0))), dvec3(0.2));
    return volume;
}

struct Case {
    const char* name;
    Medium medium;
    Ray ray;
};
std::vector<Case> cases() {
    const vec3 slanted = glm::normalize(vec3(1, 0.4f, 0.3f));
    const Medium grid = medium_of(holey_volume(), 1.3f);
    const vec3 middle = grid.density.bricks->bounds.center();
    return {
        {"even", homogeneous_medium(0.7f, {vec3(-1), vec3(1)}), {{-3, -0.9f, -0.8f}, slanted, 10}},
        {"even, ray ends inside", homogeneous_medium(0.7f), {{-3, 0.2f, 0.1f}, slanted, 1.5f}},
        {"height, up", height_fog(0.4f, -1, 2), {{0, -3, 0}, slanted, 60}},
        {"height, down", height_fog(0.4f, -1, 2), {{0, 9, 0}, -slanted, 40}},
        {"height, level", height_fog(0.4f, -1, 2), {{0, 0.5f, 0}, {1, 0, 0}, 4}},
        {"height, from far above", height_fog(0.1f, 0, 1, {vec3(-500), vec3(500)}), {{0, 400, 0}, {0, -1, 0}, 410}},
        {"grid", grid, {middle - 6.0f * slanted, slanted, 12}},
        {"grid, across", grid, {middle - vec3(0, 0, 6), {0, 0, 1}, 12}},
        {"grid, from inside", grid, {middle, -slanted, 2}},
    };
}

TEST(Tracking, RatioTrackingIsRightOnAverage) {
    for (const Case& c : cases()) {
        const double expected = std::exp(-optical_depth(c.medium, c.ray));
        ASSERT_LT(expected, 0.95) << c.name;
        Mean mean;
        for (uint32_t i = 0; i < 20000; ++i) {
            RandomStream random{hash(i, 11u)};
            int lookups = 0;
            mean.add(ratio_transmittance(c.medium, c.ray, {0, c.ray.t_max}, random, lookups));
        }
        EXPECT_LT(std::abs(mean.value() - expected), limit * mean.error() + 1e-6) << c.name;
        EXPECT_LT(mean.error(), 0.01) << c.name;
    }
}

// By the least densities of bricks most of it is known, inside the grid; collisions alone would leave a variance of
// e^depth - 1 times the square of what passes.
TEST(Tracking, RatioTrackingIsNearlyExactInSmoothFogAndNeverAboveOne) {
    SparseVolume smooth = volume_of(ivec3(0), ivec3(63), [](int x, int y, int z) {
        return 0.7f + 0.05f * std::sin(0.2f * static_cast<float>(x)) + 0.1f * exact_noise(x, y, z);
    });
    smooth.index_to_world = glm::scale(dmat4(1), dvec3(0.05));
    const Medium medium = medium_of(smooth, 1.0f);
    const Ray ray{medium.density.bricks->bounds.center() - vec3(1, 0, 0), glm::normalize(vec3(1, 0.1f, 0.05f)), 2};
    const double depth = optical_depth(medium, ray);
    ASSERT_GT(depth, 1);
    Mean mean;
    int lookups = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        RandomStream random{hash(i, 14u)};
        const float share = ratio_transmittance(medium, ray, {0, ray.t_max}, random, lookups);
        ASSERT_LE(share, 1);
        mean.add(share);
    }
    EXPECT_LT(std::abs(mean.value() - std::exp(-depth)), limit * mean.error());
    EXPECT_LT(mean.error() * std::sqrt(20000), 0.2 * mean.value() * std::sqrt(std::expm1(depth)));
    EXPECT_LT(lookups / 20000.0, 2 * depth);
}

TEST(Tracking, ACollisionComesBeforeADistanceAsOftenAsFogTakesLight) {
    for (const Case& c : cases())
        for (const float share : {0.35f, 0.6f, 1.0f}) {
            Ray part = c.ray;
            part.t_max *= share;
            const double expected = 1 - std::exp(-optical_depth(c.medium, part));
            Mean mean;
            for (uint32_t i = 0; i < 20000; ++i) {
                RandomStream random{hash(i, 12u)};
                int lookups = 0;
                const float first = random.next();
                const Interval<float> whole{0, c.ray.t_max};
                mean.add(collision_distance(c.medium, c.ray, whole, first, random, lookups) < part.t_max);
            }
            EXPECT_LT(std::abs(mean.value() - expected), limit * mean.error() + 1e-6) << c.name << share;
        }
}

TEST(Tracking, StretchesOfARayMultiply) {
    const Case c = cases()[6];
    Mean mean;
    for (uint32_t i = 0; i < 20000; ++i) {
        RandomStream random{hash(i, 13u)};
        int lookups = 0;
        const float split = c.ray.t_max * random.next();
        mean.add(ratio_transmittance(c.medium, c.ray, {0, split}, random, lookups) *
                 ratio_transmittance(c.medium, c.ray, {split, c.ray.t_max}, random, lookups));
    }
    EXPECT_LT(std::abs(mean.value() - std::exp(-optical_depth(c.medium, c.ray))), limit * mean.error());
}

const vec3 spectrum(2, 0.9f, 0.1f);

// Where a channel has a low weight, few samples carry all of its light: the error cannot be less than that of rare
// events.
TEST(Tracking, RatioTrackingOfChannelsIsRightOnAverage) {
    constexpr int count = 20000;
    for (const vec3 weights : {vec3(1), vec3(0.01f, 3, 0.2f)})
        for (Case& c : cases()) {
            const double depth = optical_depth(c.medium, c.ray);
            c.medium.optics.channels = spectrum;
            Mean means[3];
            for (uint32_t i = 0; i < count; ++i) {
                RandomStream random{hash(i, 15u)};
                int lookups = 0;
                const vec3 share = channel_transmittance(c.medium, weights, c.ray, {0, c.ray.t_max}, random, lookups);
                for (int k = 0; k < 3; ++k) means[k].add(share[k]);
            }
            for (int k = 0; k < 3; ++k) {
                const double expected = std::exp(-depth * spectrum[k]),
                             most = 0.1 * max_component(weights) / weights[k];
                const double error = std::max(means[k].error(), most > 1 ? std::sqrt(expected * most / count) : 0);
                EXPECT_LT(std::abs(means[k].value() - expected), limit * error + 1e-6) << c.name << k;
            }
        }
}

// Weighted by multiple importance sampling, paths that follow any channel are paths of each.
TEST(Tracking, CollisionsOfOneChannelTellOfTheOthers) {
    for (Case& c : cases())
        for (const float share : {0.35f, 0.6f}) {
            Ray part = c.ray;
            part.t_max *= share;
            const double depth = optical_depth(c.medium, part);
            Medium medium = c.medium;
            medium.optics.channels = spectrum;
            Mean means[3];
            for (uint32_t i = 0; i < 30000; ++i) {
                RandomStream random{hash(i, 16u)};
                int lookups = 0;
                vec3 pdfs(1);
                const float first = random.next();
                const Interval<float> whole{0, c.ray.t_max};
                const float found =
                    collision_distance(medium, static_cast<int>(i % 3), c.ray, whole, first, random, lookups, pdfs);
                const vec3 weights = pdfs / mean_component(pdfs);
                for (int k = 0; k < 3; ++k) means[k].add(found < part.t_max ? weights[k] : 0.0f);
            }
            for (int k = 0; k < 3; ++k)
                EXPECT_LT(std::abs(means[k].value() + std::expm1(-depth * spectrum[k])),
                          limit * means[k].error() + 1e-6)
                    << c.name << share << k;
        }
}

TEST(Tracking, GrayFogIsTheSameInAllChannels) {
    for (const Case& c : cases()) {
        RandomStream random{4}, again{4};
        int lookups = 0;
        vec3 pdfs(1);
        const Interval<float> whole{0, c.ray.t_max};
        EXPECT_EQ(channel_transmittance(c.medium, vec3(1), c.ray, whole, random, lookups),
                  vec3(ratio_transmittance(c.medium, c.ray, whole, again, lookups)));
        EXPECT_EQ(collision_distance(c.medium, 2, c.ray, whole, 0.3f, random, lookups, pdfs),
                  collision_distance(c.medium, c.ray, whole, 0.3f, again, lookups));
        EXPECT_EQ(pdfs, vec3(1));
    }
}

TEST(Tracking, EndlessFogEndsEveryRay) {
    RandomStream random{3};
    int lookups = 0;
    const Medium fog = homogeneous_medium(1e-3f);
    const Ray ray{{0, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(ratio_transmittance(fog, ray, {0, infinity}, random, lookups), 0);
    EXPECT_LT(collision_distance(fog, ray, {0, infinity}, 0.999f, random, lookups), 1e4f);
    EXPECT_EQ(collision_distance(height_fog(1, 0, 1), {{0, 100, 0}, {0, 1, 0}}, {0, infinity}, 0.5f, random, lookups),
              infinity);
}

TEST(Tracking, DensityAtAPointIsThatOfTheVectorSampler) {
    for (const Case& c : cases())
        for (uint32_t i = 0; i < 200; ++i) {
            alignas(64) float x[16], y[16], z[16], density[16];
            const vec3 point = random_point(vec3(-10), vec3(10), i, 9);
            for (int lane = 0; lane < 16; ++lane) x[lane] = point.x, y[lane] = point.y, z[lane] = point.z;
            densities(c.medium, x, y, z, density);
            EXPECT_NEAR(density_at(c.medium, point), density[0], 2e-6) << c.name;
        }
}

// Pearson's chi-square of sampled cosines over 40 bins of equal probability by numeric integration.
TEST(Phase, SampledDirectionsFollowTheValues) {
    const Phase phases[] = {{PhaseKind::isotropic, 0},
                            {PhaseKind::rayleigh, 0},
                            {PhaseKind::schlick, 0.4f},
                            {PhaseKind::henyey_greenstein, 0},
                            {PhaseKind::henyey_greenstein, 0.5f},
                            {PhaseKind::henyey_greenstein, -0.7f},
                            {PhaseKind::henyey_greenstein, 0.95f},
                            {PhaseKind::henyey_greenstein, 1.0f}};
    constexpr int samples = 200000, bins = 40, pieces = 200000;
    for (const Phase& phase : phases) {
        std::vector<double> below{0}; // share of light with cosines below -1 + 2 i / pieces
        for (int i = 0; i < pieces; ++i) {
            // Pieces even in angle, so that narrow lobes are resolved.
            const double a = pi * (1 - static_cast<double>(i) / pieces),
                         b = pi * (1 - static_cast<double>(i + 1) / pieces);
            const double middle = std::cos((a + b) / 2);
            below.push_back(below.back() +
                            2 * pi * (std::cos(b) - std::cos(a)) * phase_value(phase, static_cast<float>(middle)));
        }
        const vec3 axis = glm::normalize(vec3(0.3f, -0.5f, 0.8f));
        int counts[bins] = {}, turns[bins] = {};
        for (uint32_t i = 0; i < samples; ++i) {
            const vec2 u(random_unit(i, 0, 0, 5), random_unit(i, 0, 1, 5));
            const vec3 direction = sample_phase(phase, axis, u);
            ASSERT_NEAR(glm::length(direction), 1, 1e-5);
            const double cosine = std::clamp<double>(glm::dot(dvec3(direction), dvec3(axis)), -1, 1);
            const double place = (1 - std::acos(cosine) / pi) * pieces;
            const double share = below[std::min(static_cast<int>(place), pieces)] / below.back();
            ++counts[std::min(static_cast<int>(share * bins), bins - 1)];
            vec3 x, y;
            make_frame(axis, x, y);
            const double turn = std::atan2(glm::dot(direction, y), glm::dot(direction, x)) / (2 * pi) + 0.5;
            ++turns[std::min(static_cast<int>(turn * bins), bins - 1)];
        }
        double chi_cosine = 0, chi_turn = 0;
        constexpr double expected = static_cast<double>(samples) / bins;
        for (int b = 0; b < bins; ++b) {
            chi_cosine += std::pow(counts[b] - expected, 2) / expected;
            chi_turn += std::pow(turns[b] - expected, 2) / expected;
        }
        // 39 degrees of freedom: mean 39, standard deviation 8.8; 80 has a chance of 1e-4.
        EXPECT_LT(chi_cosine, 80) << static_cast<int>(phase.kind) << " " << phase.g;
        EXPECT_LT(chi_turn, 80) << static_cast<int>(phase.kind) << " " << phase.g;
    }
}
}
}

// Steps cover all fog, keep within their bounds, and depend on the ray alone.
#include "volume/rays/steps.h"

#include "volume/fog_fixtures.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall::test {
namespace {
std::vector<Step> steps_of(const Ray& ray, std::span<const Medium> media, const StepRule& rule = {}) {
    std::vector<Step> steps;
    append_steps(ray, media, rule, steps);
    return steps;
}
std::vector<Step> steps_of(const Ray& ray, const Medium& medium, const StepRule& rule = {}) {
    return steps_of(ray, std::span(&medium, 1), rule);
}

double marched_depth(const Medium& medium, const Ray& ray, const StepRule& rule) {
    double sum = 0;
    for (const Step& step : steps_of(ray, medium, rule))
        sum += double(density_at(medium, ray.at(0.5f * (step.low + step.high)))) * (step.high - step.low);
    return sum * gray_extinction(medium.optics);
}

bool ascending(const Ray& ray, const std::vector<Step>& steps) {
    for (size_t i = 0; i < steps.size(); ++i)
        if (!(steps[i].low < steps[i].high) || !(steps[i].low >= (i ? steps[i - 1].high : 0))) return false;
    return steps.empty() || steps.back().high <= ray.t_max;
}

float longest(const std::vector<Step>& steps) {
    float length = 0;
    for (const Step& step : steps) length = std::max(length, step.high - step.low);
    return length;
}

// Islands of noise with empty space between them, and a tile.
SparseVolume islands() {
    SparseVolume volume = volume_of(ivec3(0), ivec3(63, 63, 47), [](int x, int y, int z) {
        const bool filled = hash(uint32_t(x / 11), uint32_t(y / 11), uint32_t(z / 11)) % 4 == 0;
        return filled ? 0.1f + 0.9f * exact_noise(x, y, z) : 0.0f;
    });
    volume.tiles.push_back({ivec3(0, 0, 48), ivec3(31, 31, 79), 0.5f});
    volume.active_high = ivec3(63, 63, 79);
    volume.index_to_world =
        glm::rotate(glm::scale(dmat4(1), dvec3(0.25, 0.25, 0.5)), 0.5, glm::normalize(dvec3(1, 2, 3)));
    return volume;
}

Ray ray_through(const Box& box, uint32_t i) {
    const vec3 margin(2);
    return ray_between(random_point(box.low - margin, box.high + margin, i, 20),
                       random_point(box.low - margin, box.high + margin, i, 21));
}

TEST(Steps, HomogeneousSlabIsExactAtAnyCount) {
    const Medium slab = homogeneous_medium(0.7f, {vec3(-100, 1, -100), vec3(100, 4, 100)});
    const Ray ray{vec3(0.3f, 9, 0), glm::normalize(vec3(0.2f, -1, 0.1f))};
    const double exact = optical_depth(slab, ray);
    for (const float depth : {100.0f, 1.0f, 0.3f, 0.05f, 0.002f}) {
        StepRule rule;
        rule.optical_depth = depth, rule.length = 50;
        EXPECT_EQ(steps_of(ray, slab, rule).size(), size_t(std::ceil(exact / depth)));
        EXPECT_NEAR(marched_depth(slab, ray, rule) / exact, 1, 1e-5) << depth;
    }
}

TEST(Steps, HeightFogConverges) {
    const float falloff = 2;
    const Medium fog = height_fog(0.4f, 1, falloff);
    for (uint32_t i = 0; i < 20; ++i) {
        const Ray ray = ray_between(random_point(vec3(-9, -3, -9), vec3(9, 12, 9), i, 0),
                                    random_point(vec3(-9, -3, -9), vec3(9, 12, 9), i, 1));
        const double exact = optical_depth(fog, ray);
        for (const float length : {1.0f, 0.25f, 0.0625f}) {
            StepRule rule;
            rule.length = length;
            // The midpoint rule on an exponential is off by (dt/H)²/24 at most.
            const double bound = length * length / (falloff * falloff) / 24 * 1.1 + 1e-6;
            EXPECT_NEAR(marched_depth(fog, ray, rule) / exact, 1, bound);
        }
    }
}

TEST(Steps, BrickDepthConverges) {
    const Medium fog = medium_of(islands(), 0.5f);
    double coarse = 0, fine = 0, exact = 0;
    for (uint32_t i = 0; i < 200; ++i) {
        const Ray ray = ray_through(fog.density.bricks->bounds, i);
        StepRule rule;
        rule.voxels = 0.5f;
        coarse += marched_depth(fog, ray, rule);
        rule.voxels = 0.0625f;
        fine += marched_depth(fog, ray, rule);
        exact += optical_depth(fog, ray);
    }
    EXPECT_NEAR(coarse / exact, 1, 5e-3);
    EXPECT_NEAR(fine / exact, 1, 2e-4);
}

// Fog as dense at the faces of its box as inside, but for the voxel in which samples fall to 0.
TEST(Steps, LongStepsKnowThatFogEndsWithinAVoxel) {
    const Medium fog = medium_of(volume_of(ivec3(0), ivec3(39, 23, 31), [](int, int, int) { return 1.0f; }), 0.5f);
    for (const float voxels : {1.5f, 2.0f, 4.0f, 8.0f}) {
        StepRule rule;
        rule.voxels = voxels, rule.optical_depth = 10, rule.length = 50;
        double marched = 0, exact = 0;
        for (uint32_t i = 0; i < 200; ++i) {
            const Ray ray = ray_through(fog.density.bricks->bounds, i);
            marched += marched_depth(fog, ray, rule), exact += optical_depth(fog, ray);
        }
        EXPECT_NEAR(marched / exact, 1, 0.004) << "steps of " << voxels;
    }
}

TEST(Steps, CoverAllFog) {
    const std::vector<Medium> media{medium_of(islands(), 0.5f),
                                    homogeneous_medium(0.2f, {vec3(-9, 0, 0), vec3(-4, 9, 9)}),
                                    height_fog(0.1f, -2, 0.7f, {vec3(0, -4, 0), vec3(9, 3, 9)})};
    Box box = media[0].density.bricks->bounds;
    box.grow(media[1].density.bounds), box.grow(media[2].density.bounds);
    for (uint32_t i = 0; i < 300; ++i) {
        const Ray ray = ray_through(box, i);
        StepRule rule;
        rule.voxels = 0.9f;
        const std::vector<Step> steps = steps_of(ray, media, rule);
        ASSERT_TRUE(ascending(ray, steps));
        size_t at = 0;
        for (int k = 0; k < 1000; ++k) {
            const float t = ray.t_max * (static_cast<float>(k) + 0.5f) / 1000, tolerance = 1e-5f * ray.t_max;
            while (at < steps.size() && steps[at].high + tolerance < t) ++at;
            if (at < steps.size() && steps[at].low - tolerance <= t) continue;
            for (const Medium& medium : media) ASSERT_EQ(density_at(medium, ray.at(t)), 0) << i << " at " << t;
        }
    }
}

TEST(Steps, NoneInEmptySpace) {
    // Two single bricks of fog 100 voxels apart: what lies between takes no steps.
    SparseVolume volume = constant_box(8, 0.5f);
    volume.leaves.push_back({ivec3(104, 0, 0), volume.leaves[0].values});
    const std::vector<Step> steps = steps_of(Ray{vec3(-20, 4, 4), vec3(1, 0, 0)}, medium_of(volume));
    double length = 0;
    for (const Step& step : steps) length += step.high - step.low;
    EXPECT_LE(length, 4 * 8 + 1e-3);
    EXPECT_GE(length, 2 * 9 - 1e-3);
    EXPECT_TRUE(steps_of(Ray{vec3(-20, 40, 4), vec3(1, 0, 0)}, medium_of(volume)).empty());
    EXPECT_TRUE(steps_of(Ray{}, medium_of(SparseVolume())).empty());
    EXPECT_TRUE(steps_of(Ray{}, std::span<const Medium>()).empty());
}

TEST(Steps, KeepWithinTheirBounds) {
    const Medium fog = medium_of(islands(), 5);
    const float voxel = 0.5f; // the longest axis of a voxel
    for (uint32_t i = 0; i < 200; ++i) {
        const Ray ray = ray_through(fog.density.bricks->bounds, i);
        StepRule rule;
        rule.optical_depth = 1e6f, rule.length = 0.3f, rule.voxels = 1e6f;
        EXPECT_LE(longest(steps_of(ray, fog, rule)), 0.3f * 1.0001f);
        rule.length = 1e6f, rule.voxels = 1.5f;
        if (i % 2) continue;
        rule.optical_depth = 0.1f;
        for (const Step& step : steps_of(ray, fog, rule)) {
            // By the density really there: at most the majorant says.
            EXPECT_LE(optical_depth(fog, {ray.at(step.low), ray.direction, step.high - step.low}), 0.1 * 1.001);
        }
        rule.optical_depth = 1e6f;
        SparseVolume noise = volume_of(ivec3(0), ivec3(31), exact_noise);
        noise.index_to_world = glm::scale(dmat4(1), dvec3(voxel));
        EXPECT_LE(longest(steps_of(ray, medium_of(noise), rule)), 1.5f * voxel * 1.0001f);
    }
}

TEST(Steps, ConstantFogHasNoVoxelLimit) {
    StepRule rule;
    rule.optical_depth = 1e6f, rule.length = 1e6f, rule.voxels = 0.01f;
    SparseVolume volume;
    volume.active_high = ivec3(255);
    volume.tiles.push_back({ivec3(0), ivec3(255), 0.5f});
    const Ray inside = ray_between(vec3(20), vec3(200, 220, 230));
    EXPECT_EQ(steps_of(inside, medium_of(volume), rule).size(), 1u);
    EXPECT_EQ(steps_of(inside, homogeneous_medium(3), rule).size(), 1u);
}

TEST(Steps, HalvingTheRuleHalvesTheSteps) {
    const std::vector<Medium> media{medium_of(islands(), 0.5f), height_fog(0.1f, -2, 0.7f)};
    const vec3 lights[] = {vec3(3, 4, 5), vec3(0)};
    for (uint32_t i = 0; i < 100; ++i) {
        const Ray ray = ray_through(media[0].density.bricks->bounds, i);
        const StepRule whole{0.25f, 2, 1, 100000, lights, 0.25f}, half{0.125f, 1, 0.5f, 100000, lights, 0.125f};
        const double a = double(steps_of(ray, media, whole).size()), b = double(steps_of(ray, media, half).size());
        EXPECT_GE(b, 2 * a - 20); // a part of the last step of each of a few stretches
        EXPECT_LE(b, 2 * a);
        EXPECT_LE(longest(steps_of(ray, media, half)), 0.5f * 1.0001f);
    }
}

TEST(Steps, EqualShareOfTheBounds) {
    // Thin and thick halves: 10 m at 0.1/m and 10 m at 1/m, the step following the density, no sliver between them.
    const std::vector<Medium> media{homogeneous_medium(0.1f, {vec3(0), vec3(10, 1, 1)}),
                                    homogeneous_medium(1, {vec3(10, 0, 0), vec3(20, 1, 1)})};
    StepRule rule;
    rule.optical_depth = 0.25f, rule.length = 100;
    const std::vector<Step> steps = steps_of(Ray{vec3(-5, 0.5f, 0.5f), vec3(1, 0, 0)}, media, rule);
    EXPECT_EQ(steps.size(), 44u);
    for (const Step& step : steps) {
        EXPECT_GE(step.high - step.low, 0.249f);
        const double low = step.low - 5, high = step.high - 5;
        const double depth =
            0.1 * (std::min(high, 10.0) - std::min(low, 10.0)) + std::max(high, 10.0) - std::max(low, 10.0);
        EXPECT_NEAR(depth, 0.25, 1e-4);
    }
}

TEST(Steps, AddExtinctionsOfOverlappingMedia) {
    const std::vector<Medium> media{homogeneous_medium(0.1f),
                                    homogeneous_medium(0.3f, {vec3(2, -1, -1), vec3(4, 1, 1)}),
                                    homogeneous_medium(0.6f, {vec3(3, -1, -1), vec3(6, 1, 1)})};
    StepRule rule;
    rule.optical_depth = 1e-3f, rule.length = 100;
    const auto steps = steps_of(Ray{vec3(0), vec3(1, 0, 0), 10}, media, rule);
    const double depth = 0.1 * 10 + 0.3 * 2 + 0.6 * 3;
    EXPECT_EQ(steps.size(), size_t(std::ceil(depth / 1e-3 - 1e-4)));
}

TEST(Steps, ShrinkTowardsLocalLights) {
    const Medium fog = homogeneous_medium(0.01f);
    const vec3 lights[] = {vec3(10, 0.5f, 0), vec3(30, 0, 0.01f)};
    StepRule rule;
    rule.length = 5, rule.near_points = lights, rule.near_ratio = 0.25f, rule.optical_depth = 10;
    const Ray ray{vec3(0), vec3(1, 0, 0), 60};
    const auto steps = steps_of(ray, fog, rule);
    for (const Step& step : steps)
        for (const vec3 light : lights) {
            const float distance = glm::distance(light, ray.at(0.5f * (step.low + step.high)));
            // A step may reach half a length into the next shell, whose bound is half as large.
            EXPECT_LE(step.high - step.low, 0.25f * distance * 1.2f) << step.low;
        }
    EXPECT_GT(steps.size(), 50u);
    EXPECT_LT(steps.size(), 300u);
    rule.near_points = {};
    EXPECT_EQ(steps_of(ray, fog, rule).size(), 12u);
}

// Two beams that overlap, one that is wider than its steps are anyway, and one outside the fog.
TEST(Steps, BeamsGetStepsOfTheirOwn) {
    const Medium fog = homogeneous_medium(0.01f, {vec3(0, -1, -1), vec3(20, 1, 1)});
    const Step beams[] = {{3, 3.2f}, {3.1f, 3.5f}, {4, 16}, {30, 31}};
    StepRule rule;
    rule.length = 1, rule.optical_depth = 10, rule.beams = beams, rule.beam_steps = 8;
    const auto steps = steps_of(Ray{vec3(0), vec3(1, 0, 0), 60}, fog, rule);
    int inside = 0;
    for (const Step& step : steps) {
        EXPECT_LE(step.high - step.low, 1.0001f);
        // Shares of the local bounds added up: a step inside one bound is no longer than that.
        const float longest = step.high <= 3.2f ? 0.2f / 8 : 0.4f / 8;
        if (step.low < 3 || step.high > 3.5f || (step.low < 3.2f && step.high > 3.2f)) continue;
        EXPECT_LE(step.high - step.low, longest * 1.0001f) << step.low;
        ++inside;
    }
    EXPECT_EQ(inside, 12);
    // 8 in the first beam, 6 in what the second has beyond it, 19.5 elsewhere.
    EXPECT_EQ(steps.size(), 34u);
}

TEST(Steps, RayThroughALightStaysFinite) {
    const vec3 light(7, 0, 0);
    StepRule rule;
    rule.length = 1e6f, rule.near_points = std::span(&light, 1), rule.near_ratio = 0.1f;
    const auto steps = steps_of(Ray{vec3(0), vec3(1, 0, 0), 14}, homogeneous_medium(1e-3f), rule);
    EXPECT_LT(steps.size(), 1000u);
    EXPECT_GT(steps.size(), 100u);
}

TEST(Steps, NeverMoreThanAllowed) {
    const Medium fog = medium_of(islands(), 5);
    for (const int most : {1, 2, 3, 7, 50}) {
        StepRule rule;
        rule.most = most, rule.voxels = 0.01f;
        StepRule fine;
        fine.voxels = 0.5f;
        for (uint32_t i = 0; i < 100; ++i) {
            const Ray ray = ray_through(fog.density.bricks->bounds, i);
            const auto few = steps_of(ray, fog, rule), many = steps_of(ray, fog, fine);
            ASSERT_LE(few.size(), size_t(most));
            ASSERT_TRUE(ascending(ray, few));
            if (many.empty()) continue;
            EXPECT_FLOAT_EQ(few.front().low, many.front().low);
            EXPECT_FLOAT_EQ(few.back().high, many.back().high);
        }
    }
}

TEST(Steps, FogWithoutEndIsCutWhereItIsOpaque) {
    const auto even = steps_of(Ray{vec3(0), vec3(1, 0, 0)}, homogeneous_medium(0.5f));
    EXPECT_NEAR(even.back().high, 128, 1e-3);
    const Medium fog = height_fog(0.5f, 0, 3);
    EXPECT_NEAR(steps_of(Ray{vec3(0, 9, 0), vec3(0, -1, 0)}, fog).back().high, 9 + 128 - 4, 4);
    EXPECT_LT(steps_of(Ray{vec3(0), vec3(0, 1, 0)}, fog).back().high, 3 * 24 * 0.6932);
    const auto level = steps_of(Ray{vec3(0, 3, 0), vec3(1, 0, 0)}, fog);
    EXPECT_NEAR(level.back().high, 128 * std::exp(1.0), 0.1);
    const std::vector<Medium> both{fog, medium_of(islands())};
    EXPECT_TRUE(ascending(Ray{}, steps_of(Ray{vec3(0, 3, 0), vec3(1, 0, 0)}, both)));
}

TEST(Steps, FogThatOnlyGlowsHasStepsAndWhatDoesNeitherHasNone) {
    Medium fog = homogeneous_medium(0, {vec3(-1), vec3(1)});
    const Ray ray{vec3(-3, 0, 0), vec3(1, 0, 0)};
    EXPECT_TRUE(steps_of(ray, fog).empty());
    fog.optics.emission.radiance = vec3(1);
    const auto steps = steps_of(ray, fog);
    ASSERT_FALSE(steps.empty());
    EXPECT_FLOAT_EQ(steps.front().low, 2);
    EXPECT_FLOAT_EQ(steps.back().high, 4);
}

TEST(Steps, AxisParallelAndDegenerateRays) {
    const std::vector<Medium> media{medium_of(volume_of(ivec3(0), ivec3(23), exact_noise)),
                                    homogeneous_medium(1, {vec3(0), vec3(23)})};
    std::vector<Step> steps;
    for (uint32_t i = 0; i < 20000; ++i) {
        vec3 origin = glm::round(random_point(vec3(-2), vec3(26), i, 0));
        if (i % 3 == 0) origin[i / 3 % 3] = std::nextafter(origin[i / 3 % 3], i % 2 ? 100.0f : -100.0f);
        vec3 direction(i % 2 ? 0.0f : -0.0f);
        direction[i % 3] = i / 3 % 2 ? 1.0f : -1.0f;
        if (i % 5 == 0) direction[(i + 1) % 3] = 1e-38f;
        const Ray ray{origin, direction};
        steps.clear();
        append_steps(ray, media, {}, steps);
        ASSERT_TRUE(ascending(ray, steps));
    }
    const float nan = std::nanf("");
    EXPECT_TRUE(steps_of(Ray{vec3(nan), vec3(1, 0, 0)}, media).empty());
    EXPECT_TRUE(steps_of(Ray{vec3(0), vec3(nan)}, media).empty());
    EXPECT_TRUE(steps_of(Ray{vec3(5), vec3(1, 0, 0), 0}, media).empty());
}

TEST(Steps, DependOnTheRayAlone) {
    const std::vector<Medium> media{medium_of(islands(), 0.5f), height_fog(0.1f, -2, 0.7f)};
    std::vector<std::vector<Step>> first;
    for (uint32_t i = 0; i < 50; ++i) first.push_back(steps_of(ray_through(media[0].density.bricks->bounds, i), media));
    for (uint32_t i = 50; i-- > 0;) {
        const auto again = steps_of(ray_through(media[0].density.bricks->bounds, i), media);
        ASSERT_EQ(again.size(), first[i].size());
        for (size_t k = 0; k < again.size(); ++k) {
            ASSERT_EQ(again[k].low, first[i][k].low);
            ASSERT_EQ(again[k].high, first[i][k].high);
        }
    }
}

TEST(Steps, ScaleWithTheScene) {
    SparseVolume volume = islands();
    const Medium unit = medium_of(volume, 0.5f);
    const Ray ray = ray_through(unit.density.bricks->bounds, 4);
    const size_t count = steps_of(ray, unit).size();
    ASSERT_GT(count, 10u);
    for (const float scale : {1e-3f, 1e3f}) {
        SparseVolume scaled = volume;
        scaled.index_to_world = glm::scale(dmat4(1), dvec3(scale)) * volume.index_to_world;
        StepRule rule;
        rule.length *= scale;
        const Ray far{ray.origin * scale, ray.direction, ray.t_max * scale};
        EXPECT_NEAR(double(steps_of(far, medium_of(scaled, 0.5f / scale), rule).size()), double(count), 2) << scale;
    }
}
}
}

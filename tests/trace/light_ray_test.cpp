#include "trace/lights/light_ray.h"

#include "base/random.h"
#include "scene/light.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
Light light_of(LightKind kind) {
    Light light;
    light.kind = kind;
    light.position = vec3(1, 4, 2);
    light.direction = glm::normalize(vec3(0.3f, -1, 0.2f));
    return light;
}

TEST(LightRay, HardLightsAreMetAtTheirCenter) {
    const Ray sun = ray_to_light(light_of(LightKind::sun), vec3(7), vec2(0.3f, 0.8f));
    EXPECT_EQ(sun.direction, -light_of(LightKind::sun).direction);
    EXPECT_EQ(sun.t_max, infinity);
    const Ray point = ray_to_light(light_of(LightKind::point), vec3(1, 1, 2), vec2(0.3f, 0.8f));
    EXPECT_NEAR(glm::distance(point.direction, vec3(0, 1, 0)), 0, 1e-6);
    EXPECT_LT(point.t_max, 3);
    EXPECT_GT(point.t_max, 2.999f);
}

TEST(LightRay, BallIsCoveredEvenlyAndRaysEndOnIt) {
    Light light = light_of(LightKind::point);
    light.radius = 0.5f;
    const vec3 point(1, 2, 2);
    const float half = std::asin(0.5f / 2), rim = 1 - std::cos(half);
    glm::dvec3 mean(0);
    double share = 0;
    constexpr int count = 4096;
    for (int i = 0; i < count; ++i) {
        const Sample2 u = sample2(static_cast<uint32_t>(i), 3);
        const Ray ray = ray_to_light(light, point, vec2(u.x, u.y));
        const float cosine = dot(ray.direction, vec3(0, 1, 0));
        EXPECT_GE(cosine, std::cos(half) - 1e-6f);
        EXPECT_NEAR(glm::distance(ray.at(ray.t_max), light.position), 0.5f, 4e-4f);
        mean += glm::dvec3(ray.direction) / double(count);
        share += (1 - cosine) / rim / count;
    }
    EXPECT_NEAR(share, 0.5, 1e-3); // uniform over the cap: 1 - cosine is uniform
    EXPECT_NEAR(mean.x, 0, 1e-3);
    EXPECT_NEAR(mean.z, 0, 1e-3);
}

TEST(LightRay, InsideTheBallNothingIsInTheWay) {
    Light light = light_of(LightKind::spot);
    light.radius = 0.5f;
    for (const vec3 point : {light.position, light.position + vec3(0.2f, 0.1f, 0)})
        EXPECT_EQ(ray_to_light(light, point, vec2(0.4f)).t_max, 0);
}

TEST(LightRay, SunDiscHasItsAngle) {
    Light light = light_of(LightKind::sun);
    light.angle = 0.1f;
    double share = 0;
    for (int i = 0; i < 1024; ++i) {
        const Sample2 u = sample2(static_cast<uint32_t>(i), 5);
        const Ray ray = ray_to_light(light, vec3(0), vec2(u.x, u.y));
        EXPECT_NEAR(glm::length(ray.direction), 1, 1e-5);
        const double cosine = dot(glm::dvec3(ray.direction), -glm::dvec3(light.direction));
        const double angle = std::acos(std::min(1.0, cosine));
        EXPECT_LE(angle, 0.1f + 1e-3);
        share += angle * angle / 0.01 / 1024;
    }
    EXPECT_NEAR(share, 0.5, 5e-3);
}

TEST(LightRay, PointsOnABallLookLikeAnEvenDiscFromEverySide) {
    Light light = light_of(LightKind::point);
    light.radius = 0.5f;
    constexpr int count = 8192;
    for (const vec3 side : {vec3(0, 0, 1), glm::normalize(vec3(1, 2, -1)), vec3(1, 0, 0)}) {
        int inner = 0;
        dvec3 mean(0);
        for (uint32_t i = 0; i < count; ++i) {
            const Sample2 u = sample2(i, 5), v = sample2(i, 6);
            const LightPoint point = point_on(light, {vec3(0), vec3(0, 0, 1)}, {u.x, u.y, v.x});
            const dvec3 off = point.at - point.center;
            EXPECT_LE(glm::length(off), 0.5 + 1e-6);
            inner += glm::length(off - glm::dot(off, dvec3(side)) * dvec3(side)) < 0.25;
            mean += off / double(count);
        }
        // A quarter lies within half the radius; four standard errors of as many independent points.
        EXPECT_NEAR(inner / double(count), 0.25, 4 * std::sqrt(0.25 * 0.75 / count));
        EXPECT_LT(glm::length(mean), 4 * 0.25 / std::sqrt(count));
    }
    light.radius = 0;
    EXPECT_EQ(point_on(light, {vec3(0), vec3(0, 0, 1)}, vec3(0.3f)).at, dvec3(light.position));
}
}
}

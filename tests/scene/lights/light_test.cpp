#include "scene/light.h"
#include "trace/small_scenes.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
TEST(Light, PointFollowsTheInverseSquare) {
    const Light light = point_light({1, 2, 3}, 50);
    for (const float distance : {0.01f, 0.5f, 1.0f, 20.0f, 3000.0f}) {
        const LightSample here = arrival(light, light.position + vec3(0, distance, 0));
        EXPECT_NEAR(here.irradiance.x, 50 / (distance * distance), 50 / (distance * distance) * 1e-3f);
        EXPECT_NEAR(here.distance, distance, distance * 1e-4f);
        EXPECT_NEAR(here.to_light.y, -1, 1e-6);
    }
}

TEST(Light, StaysFiniteAtItsCenter) {
    Light light = point_light(vec3(0), 1);
    EXPECT_FLOAT_EQ(arrival(light, vec3(0)).irradiance.x, 1 / (light.core * light.core));
    EXPECT_NEAR(glm::length(arrival(light, vec3(0)).to_light), 1, 1e-6);
    light.radius = 0.5f;
    EXPECT_FLOAT_EQ(arrival(light, {0.1f, 0, 0}).irradiance.x, 4) << "held inside the ball";
    EXPECT_FLOAT_EQ(arrival(light, {2, 0, 0}).irradiance.x, 0.25f);
}

TEST(Light, RangeFadesToNothing) {
    Light light = point_light(vec3(0), 1);
    light.range = 10;
    EXPECT_NEAR(arrival(light, {5, 0, 0}).irradiance.x, (1 - 1 / 16.0) / 25, 1e-7);
    EXPECT_EQ(arrival(light, {10, 0, 0}).irradiance.x, 0);
    EXPECT_EQ(arrival(light, {50, 0, 0}).irradiance.x, 0);
}

TEST(Light, SpotIsFullInsideAndNothingOutside) {
    Light light = spot_light(vec3(0), {0, -1, 0}, 9, glm::radians(10.0f), glm::radians(30.0f));
    const auto at = [&](float degrees) {
        const float angle = glm::radians(degrees);
        return arrival(light, 3.0f * vec3(std::sin(angle), -std::cos(angle), 0)).irradiance.x;
    };
    EXPECT_FLOAT_EQ(at(0), 1);
    EXPECT_FLOAT_EQ(at(9.9f), 1);
    EXPECT_EQ(at(30.1f), 0);
    EXPECT_EQ(at(180), 0);
    // KHR_lights_punctual: the square of the share of the way from cos(outer) to cos(inner).
    const double share = (std::cos(glm::radians(20.0)) - std::cos(glm::radians(30.0))) /
                         (std::cos(glm::radians(10.0)) - std::cos(glm::radians(30.0)));
    EXPECT_NEAR(at(20), share * share, 1e-5);
}

TEST(Light, ANarrowBeamKeepsItsBrightness) {
    Light light = point_light(vec3(0), 4);
    light.kind = LightKind::spot, light.direction = {0, 0, 1}; // cosines are exact on the axis
    for (const float degrees : {0.05f, 0.2f, 1.0f, 2.0f}) {
        light.inner_cone = 0, light.outer_cone = glm::radians(degrees);
        EXPECT_NEAR(arrival(light, {0, 0, 2}).irradiance.x, 1, 0.05) << degrees;
        light.inner_cone = light.outer_cone;
        EXPECT_NEAR(arrival(light, {0, 0, 2}).irradiance.x, 1, 0.15) << "sharp edge at " << degrees;
    }
}

TEST(Light, SunIsTheSameEverywhere) {
    Light sun;
    sun.kind = LightKind::sun, sun.direction = {0, -1, 0}, sun.intensity = {1, 2, 3};
    for (const vec3 point : {vec3(0), vec3(1e6f, -50, 3)}) {
        EXPECT_EQ(arrival(sun, point).irradiance, vec3(1, 2, 3));
        EXPECT_EQ(arrival(sun, point).to_light, vec3(0, 1, 0));
        EXPECT_EQ(arrival(sun, point).distance, infinity);
    }
}
}
}

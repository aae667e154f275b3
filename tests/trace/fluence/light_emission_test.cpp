// Rays from lights of any size and distance bring the light that a ball in the box receives.
#include "base/random.h"
#include "scene/light.h"
#include "support/face_lights.h"
#include "support/tiny_scenes.h"
#include "trace/fluence/light_emission.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr float ball = 0.2f; // radius, around the origin

bool meets_ball(const Ray& ray) {
    const float along = -glm::dot(ray.origin, ray.direction);
    return along > 0 && glm::length(ray.at(along)) < ball;
}

struct Received {
    double mean = 0, error = 0;
};

Received received(const Light& light) {
    Snapshot snapshot;
    snapshot.lights = {light};
    const LightSquare square = squares_of(snapshot, {vec3(-1), vec3(1)})[0];
    constexpr uint32_t count = 200'000;
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const Sample2 place = sample2(i, 1), soft = sample2(i, 2);
        const Ray ray = square.ray({place.x, place.y}, {soft.x, soft.y});
        const double value = meets_ball(ray) ? double{(square.power * square.share(ray)).x} : 0;
        sum += value, squares += value * value;
    }
    const double mean = sum / count;
    return {mean, std::sqrt((squares / count - mean * mean) / count)};
}

// A ball of radius r receives π r² of the light's radiance from each direction.
void expect_received(const Light& light, double radiance_by_solid_angle) {
    const double wanted = double{pi} * double{ball} * double{ball} * radiance_by_solid_angle;
    const Received found = received(light);
    EXPECT_NEAR(found.mean, wanted, 4 * found.error + 0.005 * wanted); // the ball is not a point
    EXPECT_LT(found.error, 0.05 * wanted) << "few of the rays that reach the box meet the ball: 1.3 %";
}

TEST(LightEmission, FacesNearAndFar) {
    const auto board = [](float distance, float side) {
        return rectangle_light({0, distance, 0}, {0, -1, 0}, vec2(side));
    };
    for (const float distance : {10.0f, 100.0f, 1000.0f}) {
        SCOPED_TRACE(distance);
        expect_received(board(distance, 1), 4 * std::asin(0.25 / (double{distance} * double{distance} + 0.25)));
    }
    expect_received(board(2, 2000), 2 * double{pi});
}

TEST(LightEmission, BallsSmallerAndLargerThanTheBox) {
    for (const auto& [distance, radius] : {std::pair{3.0f, 1.0f}, {12, 10}, {1002, 1000}, {1e5f, 1e4f}}) {
        SCOPED_TRACE(radius);
        const double sine = double{radius} / double{distance};
        Light light = sphere_light({0, distance, 0}, radius);
        light.radius = radius;
        expect_received(light, 2 * double{pi} * (1 - std::sqrt(1 - sine * sine)));
    }
}

TEST(LightEmission, SpotsThatTheBoxFillsAndThatFillTheBox) {
    for (const auto& [distance, cone] : {std::pair{300.0f, 0.7f}, {3, 0.5f}, {3, 1.5f}}) {
        SCOPED_TRACE(distance);
        Light light = point_light({0, distance, 0}, distance * distance);
        light.kind = LightKind::spot, light.direction = {0, -1, 0}, light.inner_cone = light.outer_cone = cone;
        expect_received(light, 1);
    }
}
}
}

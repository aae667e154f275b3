// Faces that glow: points picked on them against closed forms and published view factors.
#include "base/image.h"
#include "base/random.h"
#include "scene/lights/area_shape.h"
#include "scene/lights/gobo.h"
#include "support/expect.h"
#include "support/face_lights.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr uint32_t samples = 1 << 16;

// Mean over picked points of what each stands for, times a function of its direction.
template<class F> double mean_of_samples(const Light& light, vec3 point, const F& f) {
    double sum = 0;
    for (uint32_t i = 0; i < samples; ++i) {
        const Sample2 u = sample2(i, 11);
        const AreaSample sample = sample_area(*light.area, point, {u.x, u.y});
        if (sample.steradians > 0) sum += double(sample.steradians) * f(sample.direction) / samples;
    }
    return sum;
}

double steradians(const Light& light, vec3 point) {
    return mean_of_samples(light, point, [](vec3) { return 1.0; });
}

// On a surface that faces up.
double irradiance(const Light& light, vec3 point) {
    return mean_of_samples(light, point, [](vec3 d) { return double(std::max(d.y, 0.0f)); });
}

// Howell, A catalog of radiation heat transfer configuration factors: B-4, an element parallel to a rectangle a × b
// that has a corner above it, at a distance c.
double corner_factor(double a, double b, double c) {
    const double x = a / c, y = b / c, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
    return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * std::numbers::pi);
}

// The same, B-13: an element parallel to a disc of radius r, h below it and `away` from its axis.
double disc_factor(double r, double h, double away) {
    const double height = h / away, radius = r / away, z = 1 + height * height + radius * radius;
    return 0.5 * (1 - (z - 2 * radius * radius) / std::sqrt(z * z - 4 * radius * radius));
}

TEST(AreaShape, BallIsSeenUnderItsCone) {
    const Light light = sphere_light({1, 2, 3}, 0.5f);
    for (const float distance : {0.51f, 0.7f, 3.0f, 200.0f}) {
        const double expected = 2 * std::numbers::pi * (1 - std::sqrt(1 - std::pow(0.5 / double(distance), 2)));
        const double got = steradians(light, vec3(1, 2, 3) + distance * glm::normalize(vec3(1, -2, 0.5f)));
        EXPECT_NEAR(got, expected, 2e-4 * expected) << distance;
    }
    EXPECT_EQ(steradians(light, {1, 2.2f, 3}), 0) << "inside";
}

TEST(AreaShape, PicturesColorTheFaceAndTheLampThatStandsForIt) {
    // Red at the left of who looks at it, green at the right, black below.
    Image<vec3> image({8, 8});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) image.at(x, y) = x < 4 ? vec3(0.8f, 0, 0) : vec3(0, 0.4f, 0);
    const Light whole = rectangle_light({0, 0, 0}, {0, 0, 1}, {2, 1}, vec3(10));
    const Light light = picture_light(whole, make_gobo(image));
    expect_near(light.intensity, vec3(4, 2, 0), 1e-5f);
    const auto nits = [&](vec3 at) { return radiance_of(light) * face_texture(*light.area, at); };
    expect_near(nits({-0.9f, 0.45f, 0}), vec3(8, 0, 0), 1e-4f);
    expect_near(nits({0.9f, 0.45f, 0}), vec3(0, 4, 0), 1e-4f);
    expect_near(nits({-0.9f, -0.45f, 0}), vec3(0), 1e-4f);
    // Luminances of .2126 x .8 and .7152 x .4: the middle lies on the green side, and in the upper half.
    const float red = 0.2126f * 0.8f, green = 0.7152f * 0.4f;
    expect_near(light.position, vec3(0.5f * (green - red) / (green + red), 0.25f, 0), 1e-5f);
    EXPECT_EQ(face_texture(*whole.area, {0.3f, 0.2f, 0}), vec3(1));
}

TEST(AreaShape, SolidAnglesOnTheAxisAreThoseOfTheTextbook) {
    const Light disc = disc_light({0, 2, 0}, {0, -1, 0}, 0.6f),
                board = rectangle_light({0, 2, 0}, {0, -1, 0}, {2, 0.4f});
    for (const double d : {0.02, 0.3, 1.0, 1.7, 2.5, 60.0}) {
        const vec3 point(0, 2 - d, 0);
        const double of_disc = 2 * std::numbers::pi * (1 - d / std::hypot(d, 0.6));
        const double of_board = 4 * std::asin(0.2 / std::sqrt((1 + d * d) * (0.04 + d * d)));
        EXPECT_NEAR(steradians(disc, point), of_disc, 1e-3 * of_disc) << d;
        EXPECT_NEAR(steradians(board, point), of_board, 1e-3 * of_board) << d;
    }
}

TEST(AreaShape, IrradianceUnderARectangleIsThePublishedFactor) {
    const Light light = rectangle_light({0, 2, 0}, {0, -1, 0}, {1.6f, 0.8f});
    ASSERT_NEAR(light.area->right.x * light.area->right.x, 1, 1e-6);
    for (const double height : {0.05, 0.5, 3.0, 40.0})
        for (const double x : {0.0, 0.5, 2.0})
            for (const double z : {0.0, 0.3, 1.0}) {
                // The rectangle as a sum of four with a corner above the point, some of them counted off.
                double factor = 0;
                for (const double a : {0.8 - x, 0.8 + x})
                    for (const double b : {0.4 - z, 0.4 + z})
                        factor += std::copysign(1, a * b) * corner_factor(std::abs(a), std::abs(b), height);
                const double got = irradiance(light, {x, 2 - height, z});
                EXPECT_NEAR(got, std::numbers::pi * factor, 2e-3 * std::numbers::pi * factor + 1e-6)
                    << height << " " << x << " " << z;
            }
}

TEST(AreaShape, IrradianceUnderADiscIsThePublishedFactor) {
    const Light light = disc_light({0, 2, 0}, {0, -1, 0}, 0.7f);
    for (const double height : {0.1, 0.5, 1.9, 3.0, 40.0})
        for (const double away : {0.001, 0.5, 0.9, 4.0}) {
            const double expected = std::numbers::pi * disc_factor(0.7, height, away);
            EXPECT_NEAR(irradiance(light, {away, 2 - height, 0}), expected, 3e-3 * expected) << height << " " << away;
        }
}

TEST(AreaShape, OnlyTheFrontGlows) {
    for (const LightKind kind : {LightKind::rectangle, LightKind::disc}) {
        const Light one = face_light(kind, {0, 0, 0}, {0, -1, 0}, vec2(1)),
                    both = face_light(kind, {0, 0, 0}, {0, -1, 0}, vec2(1), vec3(1), true);
        EXPECT_EQ(steradians(one, {0.1f, 1, 0}), 0);
        EXPECT_EQ(rough_irradiance(one, {0.1f, 1, 0}), vec3(0));
        EXPECT_NEAR(steradians(both, {0.1f, 1, 0}), steradians(one, {0.1f, -1, 0}), 1e-3);
        EXPECT_GT(arrival(both, {0, 3, 0}).irradiance.x, 0);
        EXPECT_EQ(arrival(one, {0, 3, 0}).irradiance.x, 0);
        const Ray up{{0.2f, -1, 0.1f}, {0, 1, 0}}, down{{0.2f, 1, 0.1f}, {0, -1, 0}};
        EXPECT_FLOAT_EQ(area_hit(*one.area, up), 1);
        EXPECT_EQ(area_hit(*one.area, down), infinity);
        EXPECT_FLOAT_EQ(area_hit(*both.area, down), 1);
        EXPECT_EQ(area_hit(*one.area, {{1.2f, -1, 0}, {0, 1, 0}}), infinity) << "beside";
    }
    const Light ball = sphere_light({0, 0, 0}, 1);
    EXPECT_FLOAT_EQ(area_hit(*ball.area, {{0, 0, 3}, {0, 0, -1}}), 2);
    EXPECT_EQ(area_hit(*ball.area, {{0, 0, 3}, {0, 0, 1}}), infinity);
}

TEST(AreaShape, RoughArrivalIsNeverNothingWhereLightIs) {
    for (const Light& light : {rectangle_light(vec3(0), {0, -1, 0}, {4, 0.1f}), disc_light(vec3(0), {0, -1, 0}, 2),
                               sphere_light(vec3(0), 1)})
        for (uint32_t i = 0; i < 4096; ++i) {
            const Sample2 a = sample2(i, 3), b = sample2(i, 4);
            const vec3 point = 6.0f * (vec3(a.x, a.y, b.x) - 0.5f);
            if (!(sample_area(*light.area, point, {0.3f, 0.6f}).steradians > 0)) continue;
            EXPECT_GT(rough_irradiance(light, point).x, 0);
        }
}

TEST(AreaShape, LampThatStandsForItHasItsLightFarAway) {
    const vec3 below(3, -40, 5);
    for (const Light& light : {rectangle_light(vec3(0), {0, -1, 0}, {1, 2}, vec3(3)),
                               disc_light(vec3(0), {0, -1, 0}, 0.5f, vec3(3)), sphere_light(vec3(0), 0.5f, vec3(3))}) {
        const double expected = 3 * steradians(light, below);
        EXPECT_NEAR(arrival(light, below).irradiance.x, expected, 2e-3 * expected);
        EXPECT_NEAR(radiance_of(light).x, 3, 1e-5);
        // And where the limitation says so it is at most 10 % off, as much in one direction.
        const double distance = far_distance(*light.area, 0.1);
        double worst = 0;
        for (const vec3 side : {light.area->right, light.area->up, glm::normalize(light.area->right + light.area->up)})
            for (const float slant : {0.0f, 20.0f, 45.0f, 60.0f, 70.0f, 80.0f}) {
                const float polar = glm::radians(slant);
                const vec3 direction = std::cos(polar) * light.area->normal + std::sin(polar) * side;
                const vec3 there = static_cast<float>(distance) * direction;
                const double exact = 3 * steradians(light, there), lamp = arrival(light, there).irradiance.x;
                worst = std::max(worst, std::abs(lamp / exact - 1));
            }
        EXPECT_NEAR(worst, 0.1, 0.01) << distance;
    }
}
}
}

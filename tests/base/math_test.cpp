#include "base/math.h"
#include "base/random.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
const Box unit_box{vec3(0), vec3(1)};
constexpr Interval<float> whole{0, infinity};

void expect_interval(Interval<float> seen, float low, float high) {
    EXPECT_FLOAT_EQ(seen.low, low);
    EXPECT_FLOAT_EQ(seen.high, high);
}

TEST(Interval, LengthAndEmptiness) {
    EXPECT_TRUE(Interval<float>().empty());
    EXPECT_TRUE((Interval<float>{1, 1}.empty()));
    EXPECT_TRUE((Interval<float>{2, 1}.empty()));
    EXPECT_TRUE((Interval<float>{NAN, 1}.empty()));
    EXPECT_EQ((Interval<float>{2, 1}.length()), 0);
    EXPECT_EQ((Interval<float>{1, 3}.length()), 2);
}

TEST(Box, StartsEmptyAndGrows) {
    Box box;
    EXPECT_TRUE(box.empty());
    box.grow(Box());
    EXPECT_TRUE(box.empty());
    box.grow(vec3(1, 2, 3));
    EXPECT_FALSE(box.empty());
    EXPECT_EQ(box.size(), vec3(0));
    box.grow(Box{vec3(-1), vec3(0)});
    EXPECT_EQ(box.low, vec3(-1));
    EXPECT_EQ(box.high, vec3(1, 2, 3));
    EXPECT_EQ(box.center(), vec3(0, 0.5f, 1));
    EXPECT_FALSE(everywhere().empty());
}

TEST(Clip, ThroughInsideAndPast) {
    expect_interval(clip(unit_box, vec3(-1, 0.5f, 0.5f), vec3(1, 0, 0), whole), 1, 2);
    expect_interval(clip(unit_box, vec3(2, 0.5f, 0.5f), vec3(-1, 0, 0), whole), 1, 2);
    expect_interval(clip(unit_box, vec3(0.5f), vec3(0, 0, 1), whole), 0, 0.5f);
    expect_interval(clip(unit_box, vec3(0.5f), vec3(0, 0, 1), {0.1f, 0.3f}), 0.1f, 0.3f);
    expect_interval(clip(unit_box, vec3(-1), vec3(1), whole), 1, 2);
    EXPECT_TRUE(clip(unit_box, vec3(-1, 0.5f, 0.5f), vec3(-1, 0, 0), whole).empty());
    EXPECT_TRUE(clip(unit_box, vec3(-1, 0.5f, 0.5f), vec3(1, 0, 0), {0, 0.5f}).empty());
    EXPECT_TRUE(clip(unit_box, vec3(-1, 2, 0.5f), vec3(1, 0, 0), whole).empty());
    EXPECT_TRUE(clip(Box(), vec3(0), vec3(1, 0, 0), whole).empty());
}

TEST(Clip, DirectionOfAnyLength) {
    expect_interval(clip(unit_box, vec3(-1, 0.5f, 0.5f), vec3(4, 0, 0), whole), 0.25f, 0.5f);
    expect_interval(clip(unit_box, vec3(0.5f), vec3(0), {2, 5}), 2, 5);
    EXPECT_TRUE(clip(unit_box, vec3(1.5f), vec3(0), {2, 5}).empty());
}

TEST(Clip, ParallelToAFaceAndOnIt) {
    for (const float zero : {0.0f, -0.0f}) {
        expect_interval(clip(unit_box, vec3(-1, 0, 0.5f), vec3(1, zero, zero), whole), 1, 2);
        expect_interval(clip(unit_box, vec3(-1, 1, 1), vec3(1, zero, zero), whole), 1, 2);
        EXPECT_TRUE(clip(unit_box, vec3(-1, -1e-6f, 0.5f), vec3(1, zero, zero), whole).empty());
        EXPECT_TRUE(clip(unit_box, vec3(-1, 1.000001f, 0.5f), vec3(1, zero, zero), whole).empty());
    }
}

// 1/direction overflows and 0·infinity appears: the ray still has to be found inside.
TEST(Clip, AlmostParallelOnAFace) {
    for (const float tiny : {1e-45f, -1e-45f, 1e-38f}) {
        const Interval<float> inside = clip(unit_box, vec3(-1, 0.5f, 0.5f), vec3(1, tiny, 0), whole);
        expect_interval(inside, 1, 2);
        EXPECT_TRUE(clip(unit_box, vec3(-1, 2, 0.5f), vec3(1, tiny, 0), {0, 1e6f}).empty());
    }
    expect_interval(clip(unit_box, vec3(-1, 0, 0.5f), vec3(1, 1e-45f, 0), whole), 1, 2);
}

TEST(Clip, EverywhereLeavesTheRange) {
    expect_interval(clip(everywhere(), vec3(1, 2, 3), vec3(0, 1, 0), {2, 7}), 2, 7);
    expect_interval(clip(everywhere(), vec3(1, 2, 3), glm::normalize(vec3(1, -1, 2)), whole), 0, infinity);
}

// A point of the clipped stretch is in the box, a point outside it is not.
TEST(Clip, AgreesWithPointsOnRandomRays) {
    const Box box{vec3(-1, 0, 2), vec3(3, 0.5f, 7)};
    const auto inside = [&](vec3 p, float slack) {
        return glm::all(glm::greaterThan(p, box.low - slack)) && glm::all(glm::lessThan(p, box.high + slack));
    };
    for (uint32_t i = 0; i < 5000; ++i) {
        const auto number = [&](uint32_t dimension) { return 10 * random_unit(i, 0, dimension, 1) - 5; };
        const vec3 origin(number(0), number(1), number(2)), direction(number(3), number(4), number(5));
        const Interval<float> seen = clip(box, origin, direction, {0, 4});
        for (int k = 0; k <= 20; ++k) {
            const float t = 0.2f * static_cast<float>(k);
            const vec3 point = origin + t * direction;
            const bool clipped_in = !seen.empty() && t > seen.low && t < seen.high;
            EXPECT_TRUE(!clipped_in || inside(point, 1e-4f)) << i;
            EXPECT_TRUE(!inside(point, -1e-4f) || (t >= seen.low - 1e-4f && t <= seen.high + 1e-4f)) << i;
        }
    }
}

TEST(Transform, BoxAroundTheCorners) {
    const mat4 matrix = glm::rotate(glm::translate(mat4(1), vec3(10, 0, 0)), pi / 4, vec3(0, 1, 0));
    const Box box = transform(matrix, Box{vec3(-1), vec3(1)});
    const float root = std::sqrt(2.0f);
    EXPECT_NEAR(box.low.x, 10 - root, 1e-5);
    EXPECT_NEAR(box.high.x, 10 + root, 1e-5);
    EXPECT_NEAR(box.low.y, -1, 1e-6);
    EXPECT_NEAR(box.high.z, root, 1e-5);
    EXPECT_TRUE(transform(matrix, Box()).empty());
    const Box slab{vec3(-infinity, 0, -infinity), vec3(infinity, 1, infinity)};
    for (const Box& infinite : {everywhere(), slab}) {
        EXPECT_EQ(transform(matrix, infinite).low, vec3(-infinity));
        EXPECT_EQ(transform(matrix, infinite).high, vec3(infinity));
    }
    const Box mirrored = transform(glm::scale(mat4(1), vec3(-2, 1, 1)), unit_box);
    EXPECT_EQ(mirrored.low, vec3(-2, 0, 0));
    EXPECT_EQ(mirrored.high, vec3(0, 1, 1));
}

void expect_frame(vec3 axis) {
    vec3 u, v;
    make_frame(axis, u, v);
    const std::string where = std::to_string(axis.x) + " " + std::to_string(axis.y) + " " + std::to_string(axis.z);
    EXPECT_NEAR(glm::length(u), 1, 2e-6) << where;
    EXPECT_NEAR(glm::length(v), 1, 2e-6) << where;
    EXPECT_NEAR(glm::dot(u, v), 0, 2e-6) << where;
    EXPECT_NEAR(glm::dot(u, axis), 0, 2e-6) << where;
    EXPECT_NEAR(glm::dot(v, axis), 0, 2e-6) << where;
    EXPECT_NEAR(glm::distance(glm::cross(u, v), axis), 0, 4e-6) << where;
}

TEST(Frame, IsOrthonormalAndRightHandedForEveryAxis) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
            vec3 direction(0);
            direction[axis] = sign;
            expect_frame(direction);
        }
    expect_frame(vec3(0, 0, -0.0f) + vec3(1, 0, 0));
    expect_frame(glm::normalize(vec3(1e-4f, -1e-4f, -1)));
    expect_frame(glm::normalize(vec3(1e-20f, 0, -1)));
    expect_frame(glm::normalize(vec3(1, 1, -1e-7f)));
    for (uint32_t i = 0; i < 2000; ++i) {
        const float z = 2 * random_unit(i, 0, 0, 5) - 1, angle = 2 * pi * random_unit(i, 0, 1, 5),
                    r = std::sqrt(1 - z * z);
        expect_frame(glm::normalize(vec3(r * std::cos(angle), r * std::sin(angle), z)));
    }
}

TEST(Color, LuminanceOfWhiteIsOne) {
    EXPECT_FLOAT_EQ(luminance(vec3(1)), 1);
    EXPECT_GT(luminance(vec3(0, 1, 0)), luminance(vec3(1, 0, 0)));
    EXPECT_EQ(max_component(vec3(1, 3, 2)), 3);
    EXPECT_FALSE(is_finite(vec3(0, NAN, 0)));
    EXPECT_FALSE(is_finite(vec3(0, 0, infinity)));
    EXPECT_TRUE(is_finite(vec3(1e38f)));
}
}
}

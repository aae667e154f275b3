#include "volume/fog_fixtures.h"
#include "volume/rays/fog_reach.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const Ray forward{vec3(0), vec3(0, 0, -1), infinity};

}

TEST(FogReach, IsNothingWithoutFog) {
    EXPECT_EQ(fog_reach({}, forward), 0);
    const std::vector behind{homogeneous_medium(1, {vec3(-1, -1, 5), vec3(1, 1, 9)})};
    EXPECT_EQ(fog_reach(behind, forward), 0);
}

TEST(FogReach, EndsWhereBoundedFogEnds) {
    const std::vector media{homogeneous_medium(1, {vec3(-1, -1, -9), vec3(1, 1, -5)}),
                            homogeneous_medium(1, {vec3(-1, -1, -4), vec3(1, 1, -2)})};
    EXPECT_FLOAT_EQ(fog_reach(media, forward), 9);
    EXPECT_FLOAT_EQ(fog_reach(media, {vec3(0), vec3(0, 0, -1), 7}), 7);
}

TEST(FogReach, FollowsEndlessFogToOpticalDepth20) {
    for (const float extinction : {1e-6f, 0.01f, 1.0f, 30.0f}) {
        const std::vector media{homogeneous_medium(extinction)};
        const double depth = double{fog_reach(media, forward)} * extinction;
        EXPECT_GE(depth, 20 * (1 - 1e-6)) << extinction;
        EXPECT_LE(depth, extinction > 20 ? 30 * 1.1 : 20 * 1.1) << extinction;
    }
    // Fog so thin that it takes more than the horizon of 1e12 m.
    EXPECT_EQ(fog_reach(std::vector{homogeneous_medium(1e-15f)}, forward), 1e12f);
}

TEST(FogReach, LosesLessThanAMillionthOfFogThatThinsOut) {
    const std::vector media{height_fog(0.1f, 0, 25)};
    for (const float rise : {1.0f, 0.3f, 0.01f}) {
        Ray ray{vec3(0, 2, 0), glm::normalize(vec3(1, rise, 0)), infinity};
        const double whole = optical_depth(media[0], Ray{ray.origin, ray.direction, 1e9f});
        ray.t_max = fog_reach(media, ray);
        const double reached = optical_depth(media[0], ray);
        EXPECT_LT(ray.t_max, 1e6f) << rise;
        if (whole < 20)
            EXPECT_LT(whole - reached, 1.1e-6) << rise;
        else
            EXPECT_GE(reached, 20 * (1 - 1e-6)) << rise;
    }
}

TEST(FogReach, GoesDownIntoFogBelow) {
    const std::vector media{height_fog(0.5f, 0, 2)};
    const Ray down{vec3(0, 100, 0), vec3(0, -1, 0), infinity};
    const float reach = fog_reach(media, down);
    EXPECT_GT(reach, 130);
    EXPECT_LT(reach, 160);
}
}

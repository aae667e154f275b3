// Radiance of backgrounds by direction and pixel.
#include "base/image.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
TEST(Background, ColorSkyAndPlate) {
    BackgroundState background;
    background.color = vec3(1, 2, 3);
    background.intensity = 2;
    EXPECT_EQ(background_radiance(background, vec3(0, 1, 0), vec2(0)), vec3(2, 4, 6));

    background.kind = BackgroundKind::sky;
    background.zenith = vec3(0, 0, 9), background.ground = vec3(4, 0, 0);
    EXPECT_EQ(background_radiance(background, vec3(0, 1, 0), vec2(0)), vec3(0, 0, 18));
    EXPECT_EQ(background_radiance(background, vec3(0, -1, 0), vec2(0)), vec3(8, 0, 0));
    EXPECT_EQ(background_radiance(background, vec3(1, 0, 0), vec2(0)), vec3(2, 4, 6));
    EXPECT_NEAR(background_radiance(background, glm::normalize(vec3(1, 1e-3f, 0)), vec2(0)).x, 2, 1e-4);

    auto image = std::make_shared<Image<vec3>>(ivec2(2, 2));
    image->pixels = {vec3(0), vec3(4), vec3(8), vec3(12)};
    background.kind = BackgroundKind::image;
    background.image = image;
    EXPECT_EQ(background_radiance(background, vec3(0), vec2(0.25f, 0.25f)).x, 0);
    EXPECT_EQ(background_radiance(background, vec3(0), vec2(0.75f, 0.25f)).x, 8);
    EXPECT_EQ(background_radiance(background, vec3(0), vec2(0.5f, 0.5f)).x, 12);
    EXPECT_EQ(background_radiance(background, vec3(0), vec2(1, 1)).x, 24);
}

TEST(Background, LatLongWrapsWithoutASeam) {
    // Red is the distance from the middle column, green the row, blue the column.
    auto image = std::make_shared<Image<vec3>>(ivec2(64, 32));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) image->at(x, y) = vec3(std::abs(x - 31.5f), y, x);
    BackgroundState background;
    background.kind = BackgroundKind::image;
    background.image = image;
    background.lat_long = true;
    EXPECT_NEAR(background_radiance(background, vec3(0, 0, -1), vec2(0)).x, 0.5f, 1e-4);
    EXPECT_NEAR(background_radiance(background, vec3(1, 0, 0), vec2(0)).x, 16, 1e-3); // three quarters across
    EXPECT_NEAR(background_radiance(background, vec3(0, 0, -1), vec2(0)).y, 15.5f, 1e-3);
    const float left = background_radiance(background, glm::normalize(vec3(-1e-4f, 0, 1)), vec2(0)).x;
    const float right = background_radiance(background, glm::normalize(vec3(1e-4f, 0, 1)), vec2(0)).x;
    EXPECT_NEAR(left, right, 1e-3);
    EXPECT_NEAR(left, 31.5f, 1e-2);
    EXPECT_EQ(background_radiance(background, vec3(0, 1, 0), vec2(0)).y, 0);
    EXPECT_NEAR(background_radiance(background, vec3(1, 0, 0), vec2(0)).z, 47.5f, 1e-3);
    // A quarter turn, anticlockwise from above, brings the middle column from -z to -x.
    background.rotation = pi / 2;
    EXPECT_NEAR(background_radiance(background, vec3(-1, 0, 0), vec2(0)).z, 31.5f, 1e-3);
    EXPECT_NEAR(background_radiance(background, vec3(0, 0, -1), vec2(0)).z, 47.5f, 1e-3);
}
}
}

// What is read off a pixel.
#include "viewer/painting/shown_picture.h"

#include <gtest/gtest.h>

namespace tyndall::test {
TEST(PixelText, SaysLightStopsAndDepth) {
    PixelValues values{Image<vec3>({4, 2}), Image<float>({4, 2}, infinity)};
    values.color.at(3, 1) = vec3(0.72f), values.depth.at(3, 1) = 2.5f;
    EXPECT_EQ(pixel_text(values, {4, 2}, {3, 1}), "3, 1   R 0.72  G 0.72  B 0.72   +2.0 stops   2.5 m");
    EXPECT_EQ(pixel_text(values, {4, 2}, {0, 0}), "0, 0   R 0  G 0  B 0   no surface");
    // A quick picture is smaller than the whole one.
    EXPECT_EQ(pixel_text(values, {400, 200}, {399, 150}), "399, 150   R 0.72  G 0.72  B 0.72   +2.0 stops   2.5 m");
}
}

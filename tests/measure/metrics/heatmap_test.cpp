#include "measure/metrics/pictures.h"

#include "measure/metrics/heatmap.h"
#include "render/image/lettering.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// CIE lightness of an sRGB color, 0..100.
double lightness(Color8 color) {
    double y = 0;
    const double weights[] = {0.2126, 0.7152, 0.0722};
    for (int c = 0; c < 3; ++c) {
        const double v = color[c] / 255.0;
        y += weights[c] * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}
}

TEST(HeatMap, LightnessRisesEvenly) {
    EXPECT_EQ(heat_color(0), Color8(0, 0, 0));
    EXPECT_EQ(heat_color(1), Color8(255, 255, 255));
    EXPECT_EQ(heat_color(-1), heat_color(0));
    EXPECT_EQ(heat_color(2), heat_color(1));
    // Twenty steps of 5 on average: none less than half, none more than one and a half of that.
    for (int i = 0; i < 20; ++i) {
        const double step = lightness(heat_color((i + 1) / 20.0)) - lightness(heat_color(i / 20.0));
        EXPECT_GT(step, 2.5) << i;
        EXPECT_LT(step, 7.5) << i;
    }
}

TEST(HeatMap, LinearAndLogarithmicScales) {
    Image<float> values({100, 1});
    values.at(0, 0) = 0, values.at(1, 0) = 0.1f, values.at(2, 0) = 10, values.at(3, 0) = 1e30f;
    values.at(4, 0) = std::numeric_limits<float>::quiet_NaN(), values.at(5, 0) = infinity;
    const Image<Color8> log = heat_map(values, {1e-3, 10, true});
    EXPECT_EQ(log.at(0, 0), heat_color(0));
    EXPECT_EQ(log.at(1, 0), heat_color(0.5));
    for (const int x : {2, 3, 5}) EXPECT_EQ(log.at(x, 0), heat_color(1)) << x;
    EXPECT_EQ(log.at(4, 0), Color8(0, 255, 0));
    const Image<Color8> linear = heat_map(values, {0, 0.2, false});
    EXPECT_EQ(linear.at(1, 0), heat_color(0.5));
    EXPECT_EQ(linear.at(2, 0), heat_color(1));
}

// Pixels that texts cover.
int inked(const std::vector<std::string>& texts, int scale) {
    int count = 0;
    for (const std::string& text : texts) {
        Image<Color8> picture({200, 100});
        draw_text(picture, {0, 0}, scale, text, Color8(255));
        count += static_cast<int>(std::ranges::count(picture.pixels, Color8(255)));
    }
    return count;
}

TEST(HeatMap, StripHoldsTheScaleAndItsFigures) {
    for (const int width : {1, 50, 401, 1600}) {
        const Image<float> values({width, 3});
        const Image<Color8> map = heat_map(values, {1e-3, 10, true});
        ASSERT_EQ(map.size, ivec2(width, 3 + heat_strip_height(width)));
        int strangers = 0; // neither background nor black: the figures
        for (int x = 0; x < width; ++x) {
            EXPECT_EQ(map.at(x, 2), heat_color(0));
            EXPECT_EQ(map.at(x, 3), heat_color((x + 0.5) / width));
            EXPECT_EQ(map.at(x, map.size.y - 1), heat_color((x + 0.5) / width));
            for (int y = 3; y < map.size.y; ++y) strangers += map.at(x, y) != heat_color((x + 0.5) / width);
        }
        EXPECT_EQ(strangers, width < 100 ? 0 : inked({"0.001", "0.01", "0.1", "1", "10"}, std::max(1, width / 800)))
            << width;
    }
}

TEST(HeatMap, ErrorsRelativeToTheMean) {
    Image<vec3> reference = constant(vec3(2), {3, 1}), test = reference;
    test.at(1, 0) += vec3(1, 2, -2); // root of (1 + 4 + 4) / 3
    test.at(2, 0).x = infinity;
    const Image<float> map = error_map(test, reference, 2);
    EXPECT_EQ(map.at(0, 0), 0);
    EXPECT_FLOAT_EQ(map.at(1, 0), std::sqrt(3.0f) / 2);
    EXPECT_TRUE(std::isnan(map.at(2, 0)));
}
}

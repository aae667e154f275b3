// The colour of glowing bodies against published chromaticities.
#include "base/blackbody.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
// CIE 1931 chromaticity of linear Rec.709 (IEC 61966-2-1).
vec2 chromaticity(vec3 rgb) {
    const vec3 xyz(0.4124f * rgb.x + 0.3576f * rgb.y + 0.1805f * rgb.z,
                   0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z,
                   0.0193f * rgb.x + 0.1192f * rgb.y + 0.9505f * rgb.z);
    return vec2(xyz) / (xyz.x + xyz.y + xyz.z);
}

TEST(Blackbody, HasThePublishedChromaticities) {
    // Illuminant A of CIE 015 is a blackbody of 2856 K; the others are of the Planckian locus.
    const struct {
        float kelvin;
        vec2 published;
    } cases[] = {{2856, {0.44757f, 0.40745f}},
                 {4000, {0.3805f, 0.3768f}},
                 {6500, {0.3135f, 0.3237f}},
                 {10000, {0.2807f, 0.2884f}}};
    for (const auto& [kelvin, published] : cases) {
        const vec2 found = chromaticity(blackbody_color(kelvin));
        EXPECT_NEAR(found.x, published.x, 2e-4f) << kelvin;
        EXPECT_NEAR(found.y, published.y, 2e-4f) << kelvin;
    }
}

TEST(Blackbody, HasLuminanceOneAndStaysInGamut) {
    for (const float kelvin : {500.0f, 1000.0f, 1900.0f, 3200.0f, 6500.0f, 40000.0f, 100000.0f}) {
        const vec3 color = blackbody_color(kelvin);
        EXPECT_NEAR(luminance(color), 1, 1e-5f) << kelvin;
        EXPECT_GE(std::min({color.x, color.y, color.z}), -1e-7f) << kelvin;
        EXPECT_TRUE(is_finite(color)) << kelvin;
    }
    EXPECT_GT(blackbody_color(2000).x, blackbody_color(3000).x);
    EXPECT_GT(blackbody_color(9000).z, blackbody_color(6000).z);
}
}
}

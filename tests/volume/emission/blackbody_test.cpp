// Colors and luminances of blackbodies against published ones.
#include "volume/emission/blackbody.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tyndall {
namespace {
struct Chromaticity {
    double x, y;
};
Chromaticity chromaticity(double kelvin) {
    const dvec3 xyz = blackbody_xyz(kelvin);
    const double sum = xyz.x + xyz.y + xyz.z;
    return {xyz.x / sum, xyz.y / sum};
}

// The candela was 1/60 of the light of a square centimeter of platinum that freezes, at 2042 K (CGPM 1948).
TEST(Blackbody, FreezingPlatinumHasSixtyCandelaPerSquareCentimeter) {
    EXPECT_NEAR(blackbody_xyz(2042).y, 60e4, 60e4 * 0.005);
}

// CIE 15: standard illuminant A, 2856 K, and Planckian 6500 and 10000 K.
TEST(Blackbody, ChromaticitiesArePublishedOnes) {
    const auto expect = [](double kelvin, Chromaticity published) {
        const Chromaticity found = chromaticity(kelvin);
        EXPECT_NEAR(found.x, published.x, 2e-4) << kelvin;
        EXPECT_NEAR(found.y, published.y, 2e-4) << kelvin;
    };
    expect(2856, {0.44757, 0.40745}), expect(4000, {0.3805, 0.3768}), expect(6500, {0.3135, 0.3237});
    expect(10000, {0.2807, 0.2884});
}

TEST(Blackbody, TintsHaveLuminanceOneAndStayInGamut) {
    for (const double kelvin : {500.0, 1000.0, 1900.0, 3200.0, 6500.0, 40000.0, 100000.0}) {
        const dvec3 tint = blackbody_tint(kelvin);
        EXPECT_NEAR(luminance(tint), 1, 1e-12) << kelvin;
        EXPECT_GE(std::min({tint.x, tint.y, tint.z}), 0) << kelvin;
    }
    EXPECT_GT(blackbody_tint(2000).x, blackbody_tint(3000).x);
    EXPECT_GT(blackbody_tint(9000).z, blackbody_tint(6000).z);
}

// Wien's law puts the maximum of Planck's law, Stefan and Boltzmann's its integral.
TEST(Blackbody, PlanckHasItsMaximumAndItsIntegral) {
    constexpr double kelvin = 3000, peak = 2.897771955e-3 / kelvin;
    EXPECT_GT(planck_radiance(peak, kelvin), planck_radiance(peak * 1.001, kelvin));
    EXPECT_GT(planck_radiance(peak, kelvin), planck_radiance(peak * 0.999, kelvin));
    double sum = 0;
    for (int i = 0; i < 200000; ++i) { // even in the logarithm of the wavelength, 50 nm to 5 mm
        const double step = std::log(1e5) / 200000, wavelength = 50e-9 * std::exp((i + 0.5) * step);
        sum += planck_radiance(wavelength, kelvin) * wavelength * step;
    }
    EXPECT_NEAR(sum, 5.670374419e-8 * std::pow(kelvin, 4) * std::numbers::inv_pi, sum * 1e-5);
}

TEST(Blackbody, ColorsAreBroughtIntoGamutAtTheirLuminance) {
    EXPECT_NEAR(lowest_in_gamut(), 1900, 20);
    for (const double kelvin : {600.0, 1000.0, 1500.0, 1900.0, 3000.0}) {
        const dvec3 rgb = rec709_from_xyz(blackbody_xyz(kelvin)), shown = in_gamut(rgb);
        EXPECT_GE(std::min({shown.x, shown.y, shown.z}), 0) << kelvin;
        EXPECT_NEAR(luminance(shown), luminance(rgb), luminance(rgb) * 1e-12) << kelvin;
        EXPECT_EQ(shown == rgb, kelvin > lowest_in_gamut()) << kelvin;
    }
    EXPECT_EQ(in_gamut({-1, -1, -1}), dvec3(0));
}

// Blender's fit ends at 12000 K with this color (intern/cycles/kernel/svm/math_util.h).
TEST(Blackbody, CyclesIsStefanAndBoltzmannTimesAColorOfLuminanceOne) {
    const double power = 5.670373e-8 * 1e-6 * std::numbers::inv_pi;
    const dvec3 hot = blackbody_color(BlackbodyKind::cycles, 12000) / (power * std::pow(12000.0, 4));
    EXPECT_NEAR(hot.x, 0.8262954810, 0.002);
    EXPECT_NEAR(hot.y, 0.9945080502, 0.002);
    EXPECT_NEAR(hot.z, 1.5663077103, 0.004);
    EXPECT_NEAR(luminance(blackbody_color(BlackbodyKind::cycles, 2500)), power * std::pow(2500.0, 4), 1e-4);
    EXPECT_NEAR(luminance(blackbody_color(BlackbodyKind::cycles, 2500, 0.5)), power * (0.5 + 0.5 * std::pow(2500.0, 4)),
                1e-4);
}

// What Blender 5.0.1's Blackbody node shows: below some 1900 K it cuts the blue off, and keeps red and green.
TEST(Blackbody, CyclesCutsOffWhatIsBelowZero) {
    const double power = 5.670373e-8 * 1e-6 * std::numbers::inv_pi;
    const std::pair<double, dvec3> node[] = {{1200, {3.96553278, 0.22789729, 0}},
                                             {1600, {3.08095288, 0.48727179, 0}},
                                             {1800, {2.7711153, 0.57614315, 0}},
                                             {2200, {2.31363511, 0.70361412, 0.06542045}},
                                             {4000, {1.41411614, 0.92364192, 0.53367424}}};
    for (const auto& [kelvin, expected] : node) {
        const dvec3 found = blackbody_color(BlackbodyKind::cycles, kelvin) / (power * std::pow(kelvin, 4));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-3) << kelvin;
    }
}

// Both are the same spectrum: what is between them is its maximum and 683 lm/W per meter; pbrt counts in nanometers.
TEST(Blackbody, PbrtIsPlanckOverItsMaximum) {
    for (const double kelvin : {1000.0, 2500.0, 6500.0}) {
        const double peak = planck_radiance(2.897771955e-3 / kelvin, kelvin);
        const double ratio = luminance(blackbody_color(BlackbodyKind::kelvin, kelvin)) /
                             luminance(blackbody_color(BlackbodyKind::pbrt, kelvin));
        EXPECT_NEAR(ratio, 683e-9 * peak, ratio * 0.005) << kelvin;
    }
    EXPECT_EQ(blackbody_color(BlackbodyKind::pbrt, 100), dvec3(0));
}

TEST(Blackbody, TableHoldsItWithinATenthOfAPercent) {
    for (const BlackbodyKind kind : {BlackbodyKind::kelvin, BlackbodyKind::cycles, BlackbodyKind::pbrt}) {
        const auto table = blackbody_table(kind);
        EXPECT_EQ(table, blackbody_table(kind));
        for (double kelvin = 500.3; kelvin < 65504; kelvin *= 1.0137) {
            const vec3 expected(blackbody_color(kind, kelvin)), found = table->at(static_cast<float>(kelvin));
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-3 * max_component(expected)) << kelvin;
        }
        for (const float kelvin : {-1.0f, 0.0f, 255.0f, 256.0f}) EXPECT_EQ(table->at(kelvin), vec3(0)) << kelvin;
        EXPECT_EQ(table->at(1e9f), table->at(65536));
    }
}
}
}

#include "measure/metrics/pictures.h"

#include "base/srgb.h"
#include "measure/metrics/ssim.h"
#include "measure/metrics/tone.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr double c1 = 1e-4, c2 = 9e-4; // 0.01² and 0.03²

Image<double> checkerboard(ivec2 size, double mean, double amplitude) {
    Image<double> image(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) image.at(x, y) = mean + ((x + y) % 2 ? amplitude : -amplitude);
    return image;
}
}

TEST(Ssim, EqualPicturesAreExactlyOne) {
    for (const ivec2 size : {ivec2(1, 1), ivec2(3, 2), ivec2(40, 30)}) {
        const Image<vec3> image = shaft(size, 0, 0);
        EXPECT_EQ(ssim(image, image, mean_luminance(image)), 1);
    }
}

TEST(Ssim, EvenPicturesByHand) {
    // No variance: (2 a b + c1) / (a² + b² + c1), everywhere, borders included.
    const double a = 0.6, b = 0.3;
    for (const double value : ssim_map(Image<double>({20, 15}, a), Image<double>({20, 15}, b)).pixels)
        EXPECT_NEAR(value, (2 * a * b + c1) / (a * a + b * b + c1), 1e-12);
}

TEST(Ssim, CheckerboardsByHand) {
    // A Gaussian of σ = 1.5 leaves exp(−π² σ² / 2) = 1.5e-5 of an alternating row (its cut at ±5 leaves 4e-4 at most),
    // so the window means are the mean and the variance d²: inverted, (c2 − 2 d²) / (c2 + 2 d²).
    const double d = 0.1;
    const Image<double> map = ssim_map(checkerboard({31, 31}, 0.5, d), checkerboard({31, 31}, 0.5, -d));
    EXPECT_NEAR(map.at(15, 15), (c2 - 2 * d * d) / (c2 + 2 * d * d), 1e-3);
    // Half the contrast: covariance d²/2, variances d² and d²/4.
    const Image<double> weaker = ssim_map(checkerboard({31, 31}, 0.5, d / 2), checkerboard({31, 31}, 0.5, d));
    EXPECT_NEAR(weaker.at(15, 15), (d * d + c2) / (1.25 * d * d + c2), 1e-3);
}

TEST(Ssim, LooksAtTheDisplayedPicture) {
    // Even pictures: the reference becomes middle gray, the test is half of it.
    const double r = srgb_encoded(aces(0.18)), t = srgb_encoded(aces(0.09));
    const Image<vec3> reference = constant(vec3(40), {12, 12}), test = constant(vec3(20), {12, 12});
    EXPECT_NEAR(mean_luminance(reference), 40, 1e-5);
    EXPECT_NEAR(ssim(test, reference, 40), (2 * t * r + c1) / (t * t + r * r + c1), 1e-7);
}

TEST(Ssim, DoesNotDependOnScaleAndIsSymmetricAtOneExposure) {
    const Image<vec3> a = shaft({40, 30}, 0, 0), b = shaft({40, 30}, 1, 0.2);
    const double mean = mean_luminance(a), value = ssim(b, a, mean);
    EXPECT_GT(value, 0.3);
    EXPECT_LT(value, 0.99);
    EXPECT_NEAR(ssim(a, b, mean), value, 1e-12);
    EXPECT_NEAR(ssim(scaled(b, 1024), scaled(a, 1024), 1024 * mean), value, 1e-12);
}

TEST(Ssim, BlackPartsOfTheReferenceDoNotCount) {
    // The right half is black in the reference and noisy in the test: it says nothing, beyond the window's reach.
    Image<vec3> reference({64, 16}, vec3(0.5f)), test = reference;
    for (int y = 0; y < 16; ++y)
        for (int x = 32; x < 64; ++x) {
            reference.at(x, y) = vec3(0);
            test.at(x, y) = vec3(x >= 48 && (x + y) % 2 ? 0.1f : 0.0f);
        }
    EXPECT_EQ(ssim(test, reference, mean_luminance(reference)), 1);
}

TEST(Ssim, BlackReferences) {
    const Image<vec3> black = constant(vec3(0));
    EXPECT_EQ(mean_luminance(black), 0);
    EXPECT_EQ(ssim(black, black, 0), 1);
    EXPECT_EQ(ssim(constant(vec3(1)), black, 0), 0);
}

TEST(Ssim, NonFinitePixelsAreBlackInBoth) {
    Image<vec3> reference = shaft({20, 20}, 0, 0), test = reference;
    test.at(5, 5).x = std::numeric_limits<float>::quiet_NaN();
    reference.at(8, 8).y = infinity;
    EXPECT_EQ(ssim(test, reference, mean_luminance(reference)), 1);
}
}

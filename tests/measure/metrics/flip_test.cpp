// The means under AgreesWithThePublishedImplementation come from flip-evaluator 1.7, the implementation of FLIP's
// authors, on the same pictures: made by formula here and there.
#include "measure/metrics/pictures.h"

#include "measure/metrics/flip.h"
#include "measure/metrics/flip_color.h"
#include "measure/metrics/tone.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const ivec2 size{64, 48};

// As a display would be given it.
Image<vec3> displayed(Image<vec3> image) {
    for (vec3& color : image.pixels) color = glm::min(0.4f * color, vec3(1));
    return image;
}

// Most of it without light.
Image<vec3> mostly_black(Image<vec3> image, bool noise) {
    for (int y = 20; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x)
            image.at(x, y) = noise ? vec3(0.01f * static_cast<float>(x % 3)) : vec3(0);
    return image;
}
}

TEST(FlipColor, KnownColors) {
    // White is (100, 0, 0) in YCxCz and CIELAB; green and blue in CIELAB are (87.74, -86.18, 83.18), (32.30, 79.19,
    // -107.86) to the rounding of the published tables, here with the Hunt factor 0.01 L.
    const auto near = [](vec3 a, vec3 b, float tolerance) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << c;
    };
    near(ycxcz_of_rgb(vec3(1)), {100, 0, 0}, 1e-4f);
    near(ycxcz_of_rgb(vec3(0)), {-16, 0, 0}, 1e-4f);
    near(hunt_lab_of_rgb(vec3(1)), {100, 0, 0}, 1e-3f);
    near(hunt_lab_of_rgb(vec3(0)), {0, 0, 0}, 1e-4f);
    near(hunt_lab_of_rgb({0, 1, 0}), {87.74f, 0.8774f * -86.18f, 0.8774f * 83.18f}, 0.05f);
    near(hunt_lab_of_rgb({0, 0, 1}), {32.30f, 0.3230f * 79.19f, 0.3230f * -107.86f}, 0.05f);
    for (const vec3 rgb : {vec3(1, 0, 0), vec3(0.2f, 0.7f, 0.01f)}) near(rgb_of_ycxcz(ycxcz_of_rgb(rgb)), rgb, 1e-5f);
    EXPECT_FLOAT_EQ(hyab({1, 2, 3}, {4, 5, 7}), 3 + 5);
}

TEST(Tone, AcesAndItsInverse) {
    for (const double y : {0.01, 0.18, 0.5, 0.85, 0.99}) EXPECT_NEAR(aces(aces_inverse(y)), y, 1e-12);
    EXPECT_NEAR(aces_inverse(0.85), 2.1188723, 1e-6);
    EXPECT_EQ(aces(0), 0);
    EXPECT_EQ(aces(-3), 0);
    EXPECT_EQ(aces(1e300), 1);
}

TEST(FlipLdr, BlackAgainstWhiteByHand) {
    // Even pictures have no features: the compressed HyAB distance of L* 0 and 100 alone. Green to blue is largest.
    const double largest = std::pow(hyab(hunt_lab_of_rgb({0, 1, 0}), hunt_lab_of_rgb({0, 0, 1})), 0.7);
    const double difference = std::pow(100, 0.7), bend = 0.4 * largest;
    const double expected = 0.95 + (difference - bend) / (largest - bend) * 0.05;
    for (const float value : flip_ldr(constant(vec3(0), {9, 9}), constant(vec3(1), {9, 9}), 67).pixels)
        EXPECT_NEAR(value, expected, 1e-4);
}

TEST(FlipLdr, AgreesWithThePublishedImplementation) {
    const Image<vec3> reference = displayed(shaft(size, 0, 0)), test = displayed(shaft(size, 1, 0.3));
    EXPECT_NEAR(flip_mean(flip_ldr(test, reference, 67)), 0.2073264, 1e-5);
    EXPECT_NEAR(flip_mean(flip_ldr(test, reference, 30)), 0.2183111, 1e-5);
}

TEST(FlipHdr, AgreesWithThePublishedImplementation) {
    const Image<vec3> reference = shaft(size, 0, 0), test = shaft(size, 1, 0.3);
    const FlipExposures exposures = flip_exposures(reference);
    EXPECT_NEAR(exposures.start, -1.5820606, 1e-5);
    EXPECT_NEAR(exposures.stop, 2.2214644, 1e-5);
    EXPECT_EQ(exposures.count, 4);
    EXPECT_NEAR(flip_mean(flip_hdr(test, reference, exposures, 67)), 0.2826200, 1e-5);
    EXPECT_NEAR(flip_mean(flip_hdr(test, reference, exposures, 30)), 0.3125581, 1e-5);
}

TEST(FlipHdr, BlackMedianCountsAsAThousandthOfTheMaximum) {
    const Image<vec3> reference = mostly_black(shaft(size, 0, 0), false),
                      test = mostly_black(shaft(size, 1, 0.3), true);
    const FlipExposures exposures = flip_exposures(reference);
    EXPECT_NEAR(exposures.stop - exposures.start, std::log2(1000), 1e-9);
    EXPECT_EQ(exposures.count, 10);
    // The published implementation, given these exposures.
    EXPECT_NEAR(flip_mean(flip_hdr(test, reference, exposures, 67)), 0.6890492, 5e-5);
}

TEST(FlipHdr, EqualPicturesAreZero) {
    const Image<vec3> image = shaft(size, 0, 0);
    EXPECT_EQ(flip_mean(flip_hdr(image, image, flip_exposures(image), 67)), 0);
}

TEST(FlipHdr, BlackReferences) {
    const Image<vec3> black = constant(vec3(0), {8, 8});
    const FlipExposures exposures = flip_exposures(black);
    EXPECT_EQ(exposures.count, 0);
    EXPECT_EQ(flip_mean(flip_hdr(black, black, exposures, 67)), 0);
    const double value = flip_mean(flip_hdr(constant(vec3(1), {8, 8}), black, exposures, 67));
    EXPECT_GT(value, 0.5);
    EXPECT_LE(value, 1);
}

TEST(FlipHdr, DoesNotDependOnScaleOrNonFinitePixels) {
    const Image<vec3> reference = shaft({32, 24}, 0, 0), test = shaft({32, 24}, 1, 0.3);
    const double value = flip_mean(flip_hdr(test, reference, flip_exposures(reference), 67));
    const Image<vec3> brighter = scaled(reference, 512);
    EXPECT_NEAR(flip_mean(flip_hdr(scaled(test, 512), brighter, flip_exposures(brighter), 67)), value, 1e-5);

    Image<vec3> broken = reference, same = reference;
    broken.at(3, 3).x = std::numeric_limits<float>::quiet_NaN(), same.at(9, 9).z = infinity;
    EXPECT_EQ(flip_mean(flip_hdr(broken, same, flip_exposures(same), 67)), 0);
    EXPECT_TRUE(std::isfinite(flip_mean(flip_hdr(scaled(test, 1e30f), reference, flip_exposures(reference), 67))));
}

TEST(FlipExposures, CoverASequence) {
    const FlipExposures frames[] = {{-1, 2, 3}, {}, {0, 4.5, 5}};
    const FlipExposures all = covering(frames);
    EXPECT_EQ(all.start, -1);
    EXPECT_EQ(all.stop, 4.5);
    EXPECT_EQ(all.count, 6);
    EXPECT_EQ(covering({}).count, 0);
}
}

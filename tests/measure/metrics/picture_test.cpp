#include "measure/metrics/pictures.h"
#include "support/expect.h"

#include "base/error.h"
#include "measure/metrics/comparison.h"
#include "measure/metrics/ssim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
ExrColors picture(const Image<vec3>& beauty) {
    ExrColors result;
    result.file = "a.exr", result.display = beauty.size, result.beauty = beauty;
    return result;
}

std::string refusal(const ExrColors& test, const ExrColors& reference) {
    return error_message(ExitCode::refused, [&] { check_same_frame(test, reference); });
}

const ivec2 size{16, 12};
}

TEST(Comparison, FramesHaveToMatch) {
    const ExrColors reference = picture(shaft(size, 0, 0));
    check_same_frame(reference, reference);
    ExrColors other = picture(shaft({16, 13}, 0, 0));
    EXPECT_THAT(refusal(other, reference), testing::HasSubstr("16 x 13"));
    other = reference, other.low = {1, 0};
    EXPECT_THAT(refusal(other, reference), testing::HasSubstr("1,0"));
    other = picture(shaft({8, 12}, 0, 0)), other.display = size;
    EXPECT_THAT(refusal(other, reference), testing::HasSubstr("--crop"));
    other = reference, other.gray = true;
    EXPECT_THAT(refusal(other, reference), testing::HasSubstr("luminance only"));
}

TEST(Comparison, WorstOfPictureAndFogLight) {
    ExrColors reference = picture(constant(vec3(4), size)), test = picture(constant(vec3(5), size));
    EXPECT_DOUBLE_EQ(compare(test, reference, viewing_of(reference.beauty)).worst_rmse(), 0.25);
    reference.layers["inscatter"] = constant(vec3(1), size), test.layers["inscatter"] = constant(vec3(1.5f), size);
    reference.layers["transmittance"] = constant(vec3(1), size), test.layers["transmittance"] = constant(vec3(3), size);
    reference.layers["light_sun"] = constant(vec3(1), size);
    const Comparison c = compare(test, reference, viewing_of(reference.beauty));
    EXPECT_DOUBLE_EQ(c.worst_rmse(), 0.5);
    ASSERT_EQ(c.layers.size(), 2u); // not the one that only the reference has
    EXPECT_EQ(c.layers[0].first, "inscatter");
    EXPECT_EQ(c.layers[1].first, "transmittance");
    EXPECT_EQ(c.layers[1].second.bias, 2);
    test.layers["inscatter"] = constant(vec3(1.125f), size);
    EXPECT_DOUBLE_EQ(compare(test, reference, viewing_of(reference.beauty)).worst_rmse(), 0.25);
}

TEST(Comparison, HalvesOfTheReferenceAndOfBoth) {
    ExrColors reference = picture(constant(vec3(2), size)), test = picture(constant(vec3(5), size));
    const Viewing viewing = viewing_of(reference.beauty);
    EXPECT_FALSE(compare(test, reference, viewing).mse);
    reference.layers["half_a"] = constant(vec3(1), size), reference.layers["half_b"] = constant(vec3(3), size);
    Comparison c = compare(test, reference, viewing);
    EXPECT_DOUBLE_EQ(c.mse->value, (5 - 1) * (5 - 3));
    EXPECT_FALSE(c.bias_squared);
    EXPECT_TRUE(c.layers.empty());
    test.layers["half_a"] = constant(vec3(6), size), test.layers["half_b"] = constant(vec3(4), size);
    c = compare(test, reference, viewing);
    EXPECT_DOUBLE_EQ(c.bias_squared->value, (6 - 1) * (4 - 3));
    EXPECT_TRUE(c.layers.empty());
}

TEST(Comparison, NoiseOfThePictureFromItsVariance) {
    const ExrColors reference = picture(constant(vec3(2), size));
    ExrColors test = picture(constant(vec3(5), size));
    const Viewing viewing = viewing_of(reference.beauty);
    EXPECT_FALSE(compare(test, reference, viewing).noise);
    test.layers["Variance"] = constant(vec3(4, 9, 14), size);
    const Comparison c = compare(test, reference, viewing);
    EXPECT_DOUBLE_EQ(*c.noise, 3);
    EXPECT_TRUE(c.layers.empty());
    test.layers["Variance"] = constant(vec3(0), size);
    const Comparison frames[] = {c, compare(test, reference, viewing)};
    EXPECT_DOUBLE_EQ(*pooled(frames).noise, std::sqrt(4.5));
}

TEST(Comparison, LdrFlipClampsAsADisplayDoes) {
    const ExrColors reference = picture(constant(vec3(2), size)), test = picture(constant(vec3(5), size));
    EXPECT_EQ(compare(test, reference, viewing_of(reference.beauty)).flip_ldr, 0);
    const ExrColors dark = picture(constant(vec3(0.2f), size));
    EXPECT_GT(compare(dark, reference, viewing_of(reference.beauty)).flip_ldr, 0.1);
}

TEST(Comparison, SequenceIsLookedAtInOneWay) {
    const Image<vec3> dark = shaft(size, 0, 0), bright = scaled(dark, 8), black(size, vec3(0));
    const Viewing frames[] = {viewing_of(dark), viewing_of(black), viewing_of(bright)};
    const Viewing all = covering(frames);
    EXPECT_DOUBLE_EQ(all.exposures.start, frames[2].exposures.start);
    EXPECT_DOUBLE_EQ(all.exposures.stop, frames[0].exposures.stop);
    EXPECT_NEAR(all.mean_luminance, 3 * mean_luminance(dark), 1e-5);
}

TEST(Comparison, SequenceOfTwoFrames) {
    ExrColors reference = picture(constant(vec3(1), size)), test = picture(constant(vec3(2), size));
    reference.layers["half_a"] = reference.layers["half_b"] = constant(vec3(1), size);
    reference.layers["inscatter"] = test.layers["inscatter"] = constant(vec3(1), size);
    const Viewing viewing = viewing_of(reference.beauty);
    const Comparison good = compare(reference, reference, viewing), bad = compare(test, reference, viewing);
    const Comparison frames[] = {good, bad};
    Comparison all = pooled(frames);
    EXPECT_DOUBLE_EQ(all.beauty.rmse, std::sqrt(0.5));
    EXPECT_DOUBLE_EQ(all.worst_rmse(), std::sqrt(0.5));
    EXPECT_DOUBLE_EQ(all.flip, bad.flip / 2);
    EXPECT_DOUBLE_EQ(all.ssim, (1 + bad.ssim) / 2);
    EXPECT_DOUBLE_EQ(all.mse->value, 0.5);
    EXPECT_EQ(all.layers.size(), 1u);
    // A layer or estimate that one frame lacks is none of the sequence.
    const Comparison heterogeneous[] = {good, compare(picture(test.beauty), picture(reference.beauty), viewing)};
    all = pooled(heterogeneous);
    EXPECT_TRUE(all.layers.empty());
    EXPECT_FALSE(all.mse);
}
}

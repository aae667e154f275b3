#include "measure/metrics/pictures.h"

#include "measure/metrics/metrics.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

// Gray pixels from left to right.
Image<vec3> gray_row(const std::vector<float>& values) {
    Image<vec3> image({static_cast<int>(values.size()), 1});
    for (size_t i = 0; i < values.size(); ++i) image.pixels[i] = vec3(values[i]);
    return image;
}
}

TEST(Errors, TwoByTwoByHand) {
    // Differences: 1 once and -0.5 three times over 12 values; the reference's mean is 3 * 8 / 12 = 2.
    Image<vec3> reference = constant(vec3(2)), test = reference;
    test.at(0, 0).x = 3;
    test.at(1, 1) = vec3(1.5f);
    const Errors e = measure_errors(test, reference);
    EXPECT_EQ(e.pixels, 4u);
    EXPECT_DOUBLE_EQ(e.mean_reference, 2);
    EXPECT_DOUBLE_EQ(e.mean_test, 2 - 0.5 / 12);
    EXPECT_DOUBLE_EQ(e.bias, -0.5 / 12);
    EXPECT_DOUBLE_EQ(e.rmse, std::sqrt(1.75 / 12));
    EXPECT_DOUBLE_EQ(e.mae, 2.5 / 12);
    EXPECT_DOUBLE_EQ(e.most, 1);
    EXPECT_DOUBLE_EQ(e.p95, 1); // the 12th of 12 values: 11 are only 91.7 %
    EXPECT_DOUBLE_EQ(e.rel_mse, (1.75 / 4) / 1.01 / 12);
    EXPECT_DOUBLE_EQ(e.rel_mse_trimmed, e.rel_mse); // 0.1 % of 12 values is none
    EXPECT_DOUBLE_EQ(relative(e.rmse, e.mean_reference), std::sqrt(1.75 / 12) / 2);
}

TEST(Errors, OnePixelByHand) {
    const Errors e = measure_errors(constant({1, 2, 6}, {1, 1}), constant({1, 1, 1}, {1, 1}));
    EXPECT_DOUBLE_EQ(e.bias, 2);
    EXPECT_DOUBLE_EQ(e.rmse, std::sqrt(26.0 / 3));
    EXPECT_DOUBLE_EQ(e.mae, 2);
    EXPECT_DOUBLE_EQ(e.most, 5);
    EXPECT_DOUBLE_EQ(e.rel_mse, 26 / 1.01 / 3);
}

TEST(Errors, PercentilesAndTrimmingTakeTheRightValues) {
    // Pixel i of 1000 is off by i/1000 in all channels: 3000 values, each three times.
    std::vector<float> off(1000);
    for (size_t i = 0; i < off.size(); ++i) off[i] = 1 + static_cast<float>(i) / 1024;
    std::swap(off[3], off[999]);
    Errors e = measure_errors(gray_row(off), gray_row(std::vector<float>(1000, 1)));
    EXPECT_DOUBLE_EQ(e.p95, 949.0 / 1024);   // the 2850th value
    EXPECT_DOUBLE_EQ(e.p99_9, 998.0 / 1024); // the 2997th
    EXPECT_DOUBLE_EQ(e.most, 999.0 / 1024);
    // Trimmed: without the three values of the last pixel. Sum of i² for i < n is (n-1) n (2n-1) / 6.
    const double all = 999.0 * 1000 * 1999 / 6, kept = 998.0 * 999 * 1997 / 6, unit = 1024.0 * 1024 * 1.01;
    EXPECT_NEAR(e.rel_mse, all / 1000 / unit, 1e-12);
    EXPECT_NEAR(e.rel_mse_trimmed, kept / 999 / unit, 1e-12);
}

TEST(Errors, RelativeMeasuresDoNotDependOnScale) {
    const Image<vec3> reference = shaft({40, 30}, 0, 0), test = shaft({40, 30}, 1, 0.2);
    const Errors a = measure_errors(test, reference);
    // Powers of two are exact, down to the smallest and up to the largest normal floats.
    for (const float factor : {0x1p-100f, 0.25f, 0x1p60f, 0x1p120f}) {
        const Errors b = measure_errors(scaled(test, factor), scaled(reference, factor));
        EXPECT_DOUBLE_EQ(relative(b.rmse, b.mean_reference), relative(a.rmse, a.mean_reference));
        EXPECT_DOUBLE_EQ(relative(b.bias, b.mean_reference), relative(a.bias, a.mean_reference));
        EXPECT_DOUBLE_EQ(b.p99_9, a.p99_9 * factor);
        EXPECT_DOUBLE_EQ(b.rel_mse, a.rel_mse);
    }
}

TEST(Errors, SwappingThePicturesTurnsTheBiasOnly) {
    const Image<vec3> a = shaft({40, 30}, 0, 0), b = shaft({40, 30}, 1, 0.2);
    const Errors ab = measure_errors(a, b), ba = measure_errors(b, a);
    EXPECT_EQ(ab.bias, -ba.bias);
    EXPECT_EQ(ab.rmse, ba.rmse);
    EXPECT_EQ(ab.mae, ba.mae);
    EXPECT_EQ(ab.most, ba.most);
    EXPECT_NE(ab.rel_mse, ba.rel_mse);
}

TEST(Errors, BlackAgainstBlackIsZero) {
    const Errors e = measure_errors(constant(vec3(0)), constant(vec3(0)));
    for (const double value : {e.bias, e.rmse, e.mae, e.p95, e.p99_9, e.most, e.rel_mse, e.rel_mse_trimmed,
                               relative(e.rmse, e.mean_reference), relative(e.bias, e.mean_reference)})
        EXPECT_EQ(value, 0);
}

TEST(Errors, LightAgainstBlackIsInfiniteRelativeToIt) {
    const Errors e = measure_errors(constant(vec3(-0.5f)), constant(vec3(0)));
    EXPECT_EQ(e.rmse, 0.5);
    EXPECT_EQ(relative(e.rmse, e.mean_reference), infinity);
    EXPECT_EQ(relative(e.bias, e.mean_reference), -infinity);
    EXPECT_EQ(e.rel_mse, infinity);
}

TEST(Errors, NonFinitePixelsAreCountedAndLeftOut) {
    Image<vec3> reference = constant(vec3(1), {3, 1}), test = constant(vec3(2), {3, 1});
    test.at(0, 0).y = nan_value;
    reference.at(0, 0).x = infinity;
    reference.at(1, 0).z = -infinity;
    Errors e = measure_errors(test, reference);
    EXPECT_EQ(e.non_finite_test, 1u);
    EXPECT_EQ(e.non_finite_reference, 2u);
    EXPECT_EQ(e.pixels, 1u);
    EXPECT_EQ(e.rmse, 1);
    EXPECT_EQ(e.mean_reference, 1);

    test.at(2, 0).x = nan_value;
    e = measure_errors(test, reference);
    EXPECT_EQ(e.pixels, 0u);
    for (const double value : {e.bias, e.rmse, e.mae, e.p95, e.most, e.rel_mse, relative(e.rmse, e.mean_reference)})
        EXPECT_TRUE(std::isnan(value));
}

TEST(Errors, HugeValuesDoNotOverflow) {
    const Errors e = measure_errors(constant(vec3(3e38f)), constant(vec3(-3e38f)));
    EXPECT_DOUBLE_EQ(e.rmse, 2 * double{3e38f});
    EXPECT_DOUBLE_EQ(e.bias, 2 * double{3e38f});
}

TEST(Errors, PooledFramesAreOnePicture) {
    // Two frames of different means and different numbers of finite pixels, against both side by side.
    const Image<vec3> r1 = gray_row({1, 2, 3}), t1 = gray_row({1.5f, 2, 2});
    const Image<vec3> r2 = gray_row({10, 20, 30}), t2 = gray_row({nan_value, 26, 30});
    const Errors frames[] = {measure_errors(t1, r1), measure_errors(t2, r2)};
    const Errors all = pooled(frames);
    const Errors one = measure_errors(gray_row({1.5f, 2, 2, nan_value, 26, 30}), gray_row({1, 2, 3, 10, 20, 30}));
    EXPECT_EQ(all.pixels, one.pixels);
    EXPECT_EQ(all.non_finite_test, one.non_finite_test);
    EXPECT_DOUBLE_EQ(all.mean_reference, one.mean_reference);
    EXPECT_DOUBLE_EQ(all.bias, one.bias);
    EXPECT_DOUBLE_EQ(all.rmse, one.rmse);
    EXPECT_DOUBLE_EQ(all.mae, one.mae);
    EXPECT_DOUBLE_EQ(all.most, one.most);
}

TEST(Flicker, ByHand) {
    // Errors of the two pixels: 0 0, then 1 0, then 1 -2: changes 1 0, 0 -2. Mean of the reference: 4.
    Flicker flicker;
    flicker.add_frame(gray_row({2, 2}), gray_row({2, 2}));
    EXPECT_TRUE(std::isnan(flicker.value()));
    flicker.add_frame(gray_row({5, 4}), gray_row({4, 4}));
    EXPECT_DOUBLE_EQ(flicker.value(), std::sqrt(1.0 / 2) / 3);
    flicker.add_frame(gray_row({7, 4}), gray_row({6, 6}));
    EXPECT_DOUBLE_EQ(flicker.value(), std::sqrt((1.0 + 4) / 4) / 4);
}

TEST(Flicker, ConstantErrorDoesNotFlicker) {
    Flicker still, moving, pulsing;
    for (int frame = 0; frame < 4; ++frame) {
        const Image<vec3> reference = gray_row({1, 2, static_cast<float>(frame)});
        still.add_frame(gray_row({1.5f, 1, 3}), gray_row({1, 2, 3}));
        moving.add_frame(gray_row({1.5f, 1, static_cast<float>(frame) + 2}), reference);
        pulsing.add_frame(gray_row({frame % 2 ? 1.25f : 0.75f, 2, 3}), gray_row({1, 2, 3}));
    }
    EXPECT_EQ(still.value(), 0);
    EXPECT_EQ(moving.value(), 0);
    EXPECT_DOUBLE_EQ(pulsing.value(), std::sqrt(0.25 / 3) / 2); // ±0.5 between frames in one of three pixels
}

TEST(Flicker, LeavesOutWhatIsNotFinite) {
    Flicker flicker;
    flicker.add_frame(gray_row({1, 1}), gray_row({1, 1}));
    flicker.add_frame(gray_row({infinity, 2}), gray_row({1, 1}));
    flicker.add_frame(gray_row({1, 2}), gray_row({1, nan_value}));
    EXPECT_DOUBLE_EQ(flicker.value(), 1); // the one change that is known: from 1 to 2
}
}

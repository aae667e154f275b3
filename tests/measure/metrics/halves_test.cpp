#include "measure/metrics/pictures.h"

#include "base/random.h"
#include "measure/metrics/halves.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
const ivec2 size{40, 24};

// A picture with uniform noise of standard deviation `amplitude` / √3, of its own for each seed.
Image<vec3> noisy(Image<vec3> image, float amplitude, uint32_t seed) {
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            image.pixels[i][c] += amplitude * (2 * random_unit(static_cast<uint32_t>(i), 0, c, seed) - 1);
    return image;
}

struct Mean {
    double sum = 0, squares = 0, count = 0;
    void add(double value) { sum += value, squares += value * value, ++count; }
    double value() const { return sum / count; }
    double variance() const { return (squares - sum * sum / count) / (count - 1); }
    double standard_error() const { return std::sqrt(variance() / count); }
};

double mean_square(const Image<vec3>& a, const Image<vec3>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const dvec3 error = dvec3(a.pixels[i]) - dvec3(b.pixels[i]);
        sum += glm::dot(error, error) / 3;
    }
    return sum / static_cast<double>(a.pixels.size());
}
}

TEST(Halves, ByHand) {
    // Products over the three channels: (2)(1) + (1)(1) + (0)(-1) = 3, mean 1.
    const Estimate e = product_of_errors(constant({2, 1, 0}, {1, 1}), constant({1, 1, -1}, {1, 1}),
                                         constant(vec3(0), {1, 1}), constant(vec3(0), {1, 1}));
    EXPECT_DOUBLE_EQ(e.value, 1);
    EXPECT_TRUE(std::isnan(e.standard_error)); // one tile says nothing about its spread
}

TEST(Halves, StandardErrorOfTwoTilesByHand) {
    // Tiles of 8 x 8 with means 1 and 3: variance 2, of the mean of two 1. A pixel that is not finite has no weight.
    Image<vec3> a({16, 8}, vec3(1));
    for (int y = 0; y < 8; ++y)
        for (int x = 8; x < 16; ++x) a.at(x, y) = vec3(3);
    const Image<vec3> ones({16, 8}, vec3(1)), zero({16, 8}, vec3(0));
    Estimate e = product_of_errors(a, ones, zero, zero);
    EXPECT_DOUBLE_EQ(e.value, 2);
    EXPECT_DOUBLE_EQ(e.standard_error, 1);
    for (int y = 0; y < 8; ++y)
        for (int x = 8; x < 12; ++x) a.at(x, y) = vec3(infinity);
    e = product_of_errors(a, ones, zero, zero);
    EXPECT_DOUBLE_EQ(e.value, 5.0 / 3);
}

// True pictures with a known difference; both have noise much larger than it.
TEST(Halves, EstimatesAreUnbiased) {
    const Image<vec3> truth = shaft(size, 0, 0), rendering = shaft(size, 0, 0.3);
    const double bias_squared = mean_square(rendering, truth);
    const float noise = 0.3f;
    Mean mse, bias, naive, claimed_variance;
    for (uint32_t run = 0; run < 200; ++run) {
        const Image<vec3> a1 = noisy(rendering, noise, 4 * run), a2 = noisy(rendering, noise, 4 * run + 1);
        const Image<vec3> r1 = noisy(truth, noise, 4 * run + 2), r2 = noisy(truth, noise, 4 * run + 3);
        const Estimate b = product_of_errors(a1, a2, r1, r2);
        bias.add(b.value), claimed_variance.add(b.standard_error * b.standard_error);
        mse.add(product_of_errors(a1, a1, r1, r2).value - mean_square(a1, truth));
        naive.add(mean_square(a1, r1));
    }
    EXPECT_NEAR(bias.value(), bias_squared, 3 * bias.standard_error());
    EXPECT_NEAR(mse.value(), 0, 3 * mse.standard_error());
    // The plain mean square holds the noise of both: 0.03 each; the test would notice it.
    EXPECT_NEAR(naive.value(), bias_squared + 2 * noise * noise / 3, 4 * naive.standard_error());
    EXPECT_GT(naive.value() - bias_squared, 50 * bias.standard_error());
    // The claimed standard error covers the spread that was seen: the difference of the pictures varies too.
    EXPECT_GT(claimed_variance.value(), 0.8 * bias.variance());
    EXPECT_LT(claimed_variance.value(), 2 * bias.variance());
}
}

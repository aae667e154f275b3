#include "trace/view.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <set>

namespace tyndall {
namespace {
View view_with(PixelFilter filter, int samples, float radius = 1) {
    View view;
    view.filter = filter, view.pixel_samples = samples, view.filter_radius = radius;
    return view;
}

TEST(View, OneSampleIsThePixelCenter) {
    for (const PixelFilter filter : {PixelFilter::box, PixelFilter::blackman_harris})
        EXPECT_EQ(sample_point(view_with(filter, 1), ivec2(7, 3), 0).position, vec2(7.5f, 3.5f));
}

TEST(View, BoxSamplesAreStratifiedInEveryElementaryInterval) {
    const View view = view_with(PixelFilter::box, 16, 0.5f);
    for (const ivec2 cells : {ivec2(16, 1), ivec2(8, 2), ivec2(4, 4), ivec2(2, 8), ivec2(1, 16)}) {
        std::set<std::pair<int, int>> seen;
        for (int sample = 0; sample < 16; ++sample) {
            const vec2 p = sample_point(view, ivec2(5, 9), sample).position - vec2(5, 9);
            EXPECT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1) << p.x << " " << p.y;
            seen.insert({static_cast<int>(p.x * cells.x), static_cast<int>(p.y * cells.y)});
        }
        EXPECT_EQ(seen.size(), 16u) << cells.x << "x" << cells.y;
    }
}

// Variance of each filter over [-1,1], by integrating its weight.
double expected_variance(PixelFilter filter) {
    double sum = 0, weight = 0;
    for (int i = 0; i < 20000; ++i) {
        const double x = -1 + (i + 0.5) / 10000, phase = 3.141592653589793 * (x + 1);
        double w = 1;
        if (filter == PixelFilter::tent) w = 1 - std::abs(x);
        if (filter == PixelFilter::gaussian) w = std::exp(-4.5 * x * x) - std::exp(-4.5);
        if (filter == PixelFilter::blackman_harris)
            w = 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) - 0.01168 * std::cos(3 * phase);
        sum += w * x * x, weight += w;
    }
    return sum / weight;
}

TEST(View, SamplesHaveTheMomentsOfTheirFilter) {
    for (const PixelFilter filter :
         {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian, PixelFilter::blackman_harris}) {
        const float radius = 1.5f;
        const View view = view_with(filter, 4096, radius);
        glm::dvec2 mean(0), square(0);
        for (int sample = 0; sample < 4096; ++sample) {
            const vec2 p = sample_point(view, ivec2(2, 2), sample).position - vec2(2.5f);
            EXPECT_LE(max_component(vec3(glm::abs(p), 0)), radius);
            mean += glm::dvec2(p) / 4096.0, square += glm::dvec2(p * p) / 4096.0;
        }
        const double variance = expected_variance(filter) * radius * radius;
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_NEAR(mean[axis], 0, 1e-3);
            EXPECT_NEAR(square[axis], variance, 2e-3 * variance);
        }
    }
}

// Values of a linear ramp: the mean over a pixel is the value at its center.
TEST(View, FewSamplesKeepTheMeanOverManyPixels) {
    const View view = view_with(PixelFilter::blackman_harris, 4);
    vec2 mean(0);
    for (int pixel = 0; pixel < 4096; ++pixel)
        for (int sample = 0; sample < 4; ++sample) {
            const ivec2 at(pixel % 64, pixel / 64);
            mean += (sample_point(view, at, sample).position - vec2(at) - 0.5f) / (4.0f * 4096);
        }
    EXPECT_NEAR(mean.x, 0, 3e-3);
    EXPECT_NEAR(mean.y, 0, 3e-3);
}

// One of a lamp a third of a pixel off the middle: what g has for a mean over the filter, and how much samples spread.
struct Spread {
    double mean = 0, variance = 0;
};
template<class F> Spread spread(const View& view, F g) {
    Spread result;
    constexpr int count = 1 << 14;
    for (int sample = 0; sample < count; ++sample) {
        const SamplePoint point = sample_point(view, ivec2(9, 4), sample % view.pixel_samples);
        const double value = point.weight * g(point.position), off = value - result.mean;
        result.mean += off / (sample + 1), result.variance += off * (value - result.mean) / count;
    }
    return result;
}

TEST(View, SamplesAtALampKeepTheMean) {
    for (const PixelFilter filter : {PixelFilter::box, PixelFilter::blackman_harris}) {
        View plain = view_with(filter, 1 << 14), lamp = plain;
        lamp.lamps.push_back({{9.7f, 4.4f}, 0.0f});
        const auto slope = [](vec2 p) { return 1 + (p.x - 9.5) + 0.5 * (p.y - 4.5) * (p.y - 4.5); };
        const Spread wanted = spread(plain, slope), seen = spread(lamp, slope);
        EXPECT_NEAR(seen.mean, wanted.mean, 4 * std::sqrt(seen.variance / (1 << 14)));
        EXPECT_LT(seen.variance, 2 * wanted.mean * wanted.mean); // smooth light grows no worse than this
    }
}

TEST(View, GlowOfALampHasNextToNoNoise) {
    View plain = view_with(PixelFilter::blackman_harris, 1 << 14), lamp = plain;
    lamp.lamps.push_back({{9.7f, 4.4f}, 0.0f});
    const auto glow = [](vec2 p) { return 1 / glm::distance(p, vec2(9.7f, 4.4f)); };
    const Spread wanted = spread(plain, glow), seen = spread(lamp, glow);
    EXPECT_NEAR(seen.mean, wanted.mean, 4 * std::sqrt(wanted.variance / (1 << 14)));
    EXPECT_LT(seen.variance, wanted.variance / 20);
}

// A beam to the right of 10 degrees to both sides.
TEST(View, SamplesAtASpotLookForItsBeam) {
    View plain = view_with(PixelFilter::blackman_harris, 1 << 14), lamp = plain;
    lamp.lamps.push_back({{9.4f, 4.6f}, 0.0f, {1, 0}, pi / 18});
    const auto beam = [](vec2 p) {
        const vec2 off = p - vec2(9.4f, 4.6f);
        return off.x > glm::length(off) * std::cos(pi / 18) ? 1 / glm::length(off) : 0;
    };
    const Spread wanted = spread(plain, beam), seen = spread(lamp, beam);
    EXPECT_NEAR(seen.mean, wanted.mean, 4 * std::sqrt((wanted.variance + seen.variance) / (1 << 14)));
    EXPECT_LT(seen.variance, wanted.variance / 30);
}

TEST(View, OnlyPixelsAtALampAreWeighted) {
    View plain = view_with(PixelFilter::box, 16), lamp = plain;
    lamp.lamps.push_back({{30.0f, 4.4f}, 0.0f});
    for (int sample = 0; sample < 16; ++sample) {
        const SamplePoint a = sample_point(plain, ivec2(9, 4), sample), b = sample_point(lamp, ivec2(9, 4), sample);
        EXPECT_EQ(a.position, b.position);
        EXPECT_EQ(b.weight, 1);
    }
}

TEST(View, PixelSeedAndFrameDecorrelate) {
    View view = view_with(PixelFilter::box, 4);
    const vec2 p = sample_point(view, ivec2(1, 2), 0).position - vec2(1, 2);
    EXPECT_NE(p, sample_point(view, ivec2(2, 1), 0).position - vec2(2, 1));
    EXPECT_EQ(p, sample_point(view, ivec2(1, 2), 0).position - vec2(1, 2));
    view.frame = 1;
    const vec2 next_frame = sample_point(view, ivec2(1, 2), 0).position - vec2(1, 2);
    EXPECT_NE(p, next_frame);
    view.seed = 1;
    EXPECT_NE(next_frame, sample_point(view, ivec2(1, 2), 0).position - vec2(1, 2));
}
}
}

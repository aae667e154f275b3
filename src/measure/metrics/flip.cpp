#include "measure/metrics/flip.h"

#include "measure/metrics/filter.h"
#include "measure/metrics/flip_color.h"
#include "measure/metrics/metrics.h"
#include "measure/metrics/tone.h"

#include <numbers>

namespace tyndall {
namespace {
constexpr double pi_d = std::numbers::pi;
// The constants of the papers: exponents and the bend of the color difference, width of a feature in degrees, and the
// luminance at which the brightest pixel is shown.
constexpr float color_exponent = 0.7f, bend_at = 0.4f, bend_to = 0.95f, feature_exponent = 0.5f;
constexpr double feature_width = 0.082, nearly_white = 0.85, darkest_median = 1e-3;

// Contrast sensitivity of the eye as a sum of two Gaussians a·√(π/b)·exp(−π² x²/b), x in degrees, separately for
// lightness, red-green and blue-yellow: one kernel per Gaussian, both normalized together.
struct Sensitivity {
    vec3 a, b;
};
constexpr Sensitivity sensitivities[2] = {{{1, 1, 34.1f}, {0.0047f, 0.0053f, 0.04f}},
                                          {{0, 0, 13.5f}, {1e-5f, 1e-5f, 0.025f}}};

std::vector<std::vector<vec3>> sensitivity_kernels(double pixels_per_degree) {
    const double widest = 0.04;
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi_d * pi_d)) * pixels_per_degree));
    std::vector<std::vector<vec3>> kernels;
    dvec3 total(0); // of both Gaussians, each over the plane
    std::vector<std::vector<dvec3>> exact;
    for (const Sensitivity& s : sensitivities) {
        dvec3 sum(0);
        exact.emplace_back();
        for (int i = -radius; i <= radius; ++i) {
            const double x = i / pixels_per_degree;
            dvec3 weight;
            for (int c = 0; c < 3; ++c)
                weight[c] = std::sqrt(s.a[c] * std::sqrt(pi_d / s.b[c])) * std::exp(-pi_d * pi_d * x * x / s.b[c]);
            exact.back().push_back(weight), sum += weight;
        }
        total += sum * sum;
    }
    for (const std::vector<dvec3>& weights : exact) {
        kernels.emplace_back();
        for (const dvec3 weight : weights) kernels.back().push_back(vec3(weight / glm::sqrt(total)));
    }
    return kernels;
}

// The colors perceived at viewing distance, in the space where differences are measured.
Image<vec3> perceived(const Image<vec3>& ycxcz, const std::vector<std::vector<vec3>>& kernels) {
    Image<vec3> result = filtered(ycxcz, kernels[0], kernels[0]);
    const Image<vec3> second = filtered(ycxcz, kernels[1], kernels[1]);
    parallel_ranges(static_cast<int64_t>(result.pixels.size()), 4096, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            const vec3 rgb = rgb_of_ycxcz(result.pixels[i] + second.pixels[i]);
            result.pixels[i] = hunt_lab_of_rgb(glm::clamp(rgb, 0.0f, 1.0f));
        }
    });
    return result;
}

// HyAB distance, compressed: up to 0.4 of the largest possible distance (green to blue) maps to 0.95 of the range.
float color_difference(vec3 a, vec3 b) {
    static const float largest =
        std::pow(hyab(hunt_lab_of_rgb(vec3(0, 1, 0)), hunt_lab_of_rgb(vec3(0, 0, 1))), color_exponent);
    const float difference = std::pow(hyab(a, b), color_exponent), bend = bend_at * largest;
    if (difference < bend) return difference * bend_to / bend;
    return bend_to + (difference - bend) / (largest - bend) * (1 - bend_to);
}

// A Gaussian, its first derivative (edges) and its second (points), in x: the positive weights of each sum to 1, the
// negative ones to −1.
struct FeatureKernels {
    std::vector<float> smooth, edge, point;
};

void normalize_signs(std::vector<double>& weights) {
    double positive = 0, negative = 0;
    for (const double w : weights) (w > 0 ? positive : negative) += std::abs(w);
    for (double& w : weights) w /= w > 0 ? positive : negative;
}

FeatureKernels feature_kernels(double pixels_per_degree) {
    const double sigma = 0.5 * feature_width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    std::vector<double> smooth, edge, point;
    for (int x = -radius; x <= radius; ++x) {
        const double g = std::exp(-x * x / (2 * sigma * sigma));
        smooth.push_back(g), edge.push_back(-x * g), point.push_back((x * x / (sigma * sigma) - 1) * g);
    }
    normalize_signs(smooth), normalize_signs(edge), normalize_signs(point);
    return {{smooth.begin(), smooth.end()}, {edge.begin(), edge.end()}, {point.begin(), point.end()}};
}

// Strength of edges (x) and points (y) in the lightness at every pixel.
Image<vec2> features(const Image<vec3>& ycxcz, const FeatureKernels& kernels) {
    Image<float> lightness(ycxcz.size);
    for (size_t i = 0; i < lightness.pixels.size(); ++i) lightness.pixels[i] = (ycxcz.pixels[i].x + 16) / 116;
    const Image<float> edge_x = filtered(lightness, kernels.edge, kernels.smooth);
    const Image<float> edge_y = filtered(lightness, kernels.smooth, kernels.edge);
    const Image<float> point_x = filtered(lightness, kernels.point, kernels.smooth);
    const Image<float> point_y = filtered(lightness, kernels.smooth, kernels.point);
    Image<vec2> result(ycxcz.size);
    for (size_t i = 0; i < result.pixels.size(); ++i)
        result.pixels[i] = {std::hypot(edge_x.pixels[i], edge_y.pixels[i]),
                            std::hypot(point_x.pixels[i], point_y.pixels[i])};
    return result;
}

Image<vec3> ycxcz_image(const Image<vec3>& rgb) {
    Image<vec3> result = rgb;
    for (vec3& color : result.pixels) color = ycxcz_of_rgb(glm::clamp(color, 0.0f, 1.0f));
    return result;
}

// Linear display colors at an exposure.
Image<vec3> tone_mapped(const Image<vec3>& image, double exposure) {
    const double gain = std::exp2(exposure);
    Image<vec3> result(image.size);
    parallel_ranges(static_cast<int64_t>(image.pixels.size()), 4096, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            for (int c = 0; c < 3; ++c)
                result.pixels[i][c] = static_cast<float>(aces(gain * double{image.pixels[i][c]}));
    });
    return result;
}
}

Image<float> flip_ldr(const Image<vec3>& test, const Image<vec3>& reference, double pixels_per_degree) {
    assert(test.size == reference.size && pixels_per_degree > 0);
    const Image<vec3> t = ycxcz_image(test), r = ycxcz_image(reference);
    const auto sensitivity = sensitivity_kernels(pixels_per_degree);
    const FeatureKernels kernels = feature_kernels(pixels_per_degree);
    const Image<vec3> seen_t = perceived(t, sensitivity), seen_r = perceived(r, sensitivity);
    const Image<vec2> features_t = features(t, kernels), features_r = features(r, kernels);

    // Feature differences amplify color differences.
    Image<float> map(test.size);
    parallel_ranges(static_cast<int64_t>(map.pixels.size()), 4096, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            const vec2 change = glm::abs(features_r.pixels[i] - features_t.pixels[i]);
            const float feature = std::pow(std::max(change.x, change.y) / std::sqrt(2.0f), feature_exponent);
            map.pixels[i] = std::pow(color_difference(seen_t.pixels[i], seen_r.pixels[i]), 1 - feature);
        }
    });
    return map;
}

FlipExposures flip_exposures(const Image<vec3>& reference) {
    std::vector<double> luminances;
    for (const vec3 color : reference.pixels)
        if (is_finite(color)) luminances.push_back(luminance(dvec3(color)));
    std::ranges::sort(luminances);
    if (luminances.empty() || !(luminances.back() > 0)) return {};
    double median = luminances[luminances.size() / 2];
    if (!(median > 0)) median = darkest_median * luminances.back();

    const double white = aces_inverse(nearly_white);
    const FlipExposures ends{std::log2(white / luminances.back()), std::log2(white / median), 1};
    return covering({&ends, 1});
}

FlipExposures covering(std::span<const FlipExposures> frames) {
    FlipExposures all;
    for (const FlipExposures& frame : frames) {
        if (frame.count == 0) continue;
        all.start = all.count ? std::min(all.start, frame.start) : frame.start;
        all.stop = all.count ? std::max(all.stop, frame.stop) : frame.stop;
        all.count = std::max(2, static_cast<int>(std::ceil(all.stop - all.start)));
    }
    return all;
}

Image<float> flip_hdr(const Image<vec3>& test, const Image<vec3>& reference, const FlipExposures& exposures,
                      double pixels_per_degree) {
    assert(test.size == reference.size);
    Image<vec3> t = test, r = reference;
    for (size_t i = 0; i < t.pixels.size(); ++i)
        if (!comparable(t.pixels[i], r.pixels[i])) t.pixels[i] = r.pixels[i] = vec3(0);

    Image<float> worst(test.size);
    const int count = exposures.start < exposures.stop ? exposures.count : 1;
    for (int e = 0; e < count; ++e) {
        const double share = e / std::max(count - 1.0, 1.0);
        const double exposure = exposures.start + share * (exposures.stop - exposures.start);
        const Image<float> map = flip_ldr(tone_mapped(t, exposure), tone_mapped(r, exposure), pixels_per_degree);
        for (size_t i = 0; i < map.pixels.size(); ++i) worst.pixels[i] = std::max(worst.pixels[i], map.pixels[i]);
    }
    return worst;
}

double flip_mean(const Image<float>& map) {
    double sum = 0;
    for (const float value : map.pixels) sum += value;
    return sum / static_cast<double>(map.pixels.size());
}
}

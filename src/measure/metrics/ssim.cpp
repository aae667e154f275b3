#include "measure/metrics/ssim.h"

#include "base/srgb.h"
#include "measure/metrics/filter.h"
#include "measure/metrics/metrics.h"
#include "measure/metrics/tone.h"

namespace tyndall {
namespace {
constexpr int window_radius = 5;
constexpr double window_sigma = 1.5, k1 = 0.01, k2 = 0.03;
constexpr double middle_gray = 0.18, darkest_mean = 1e-3;

std::vector<double> window_weights() {
    std::vector<double> weights;
    double sum = 0;
    for (int x = -window_radius; x <= window_radius; ++x) {
        weights.push_back(std::exp(-x * x / (2 * window_sigma * window_sigma)));
        sum += weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

Image<double> window_means(const Image<double>& image) { return filtered(image, window_weights(), window_weights()); }

Image<double> window_products(const Image<double>& a, const Image<double>& b) {
    Image<double> products = a;
    for (size_t i = 0; i < a.pixels.size(); ++i) products.pixels[i] *= b.pixels[i];
    return window_means(products);
}

double shown(vec3 color, double gain) { return srgb_encoded(aces(gain * luminance(dvec3(color)))); }
}

Image<double> ssim_map(const Image<double>& test, const Image<double>& reference) {
    const Image<double> mean_t = window_means(test), mean_r = window_means(reference);
    const Image<double> tt = window_products(test, test), rr = window_products(reference, reference);
    const Image<double> tr = window_products(test, reference);
    constexpr double c1 = k1 * k1, c2 = k2 * k2;
    Image<double> result(test.size);
    for (size_t i = 0; i < result.pixels.size(); ++i) {
        const double t = mean_t.pixels[i], r = mean_r.pixels[i];
        const double variances = (tt.pixels[i] - t * t) + (rr.pixels[i] - r * r), covariance = tr.pixels[i] - t * r;
        result.pixels[i] =
            (t * r + t * r + c1) * (covariance + covariance + c2) / ((t * t + r * r + c1) * (variances + c2));
    }
    return result;
}

double mean_luminance(const Image<vec3>& image) {
    double sum = 0, count = 0;
    for (const vec3 color : image.pixels)
        if (is_finite(color)) sum += luminance(dvec3(color)), ++count;
    return count > 0 ? sum / count : 0;
}

double ssim(const Image<vec3>& test, const Image<vec3>& reference, double mean) {
    const double gain = mean > 0 ? middle_gray / mean : 1;
    Image<double> t(test.size), r(test.size);
    for (size_t i = 0; i < t.pixels.size(); ++i) {
        if (!comparable(test.pixels[i], reference.pixels[i])) continue;
        t.pixels[i] = shown(test.pixels[i], gain), r.pixels[i] = shown(reference.pixels[i], gain);
    }
    const Image<double> map = ssim_map(t, r), mean_r = window_means(r);
    double sum = 0, count = 0;
    for (size_t i = 0; i < map.pixels.size(); ++i)
        if (mean_r.pixels[i] > darkest_mean) sum += map.pixels[i], ++count;
    if (count == 0) return t.pixels == r.pixels ? 1 : 0;
    return sum / count;
}
}
